#include "frontalis/error.hpp"
#include "frontalis/model/sample_field.hpp"

#include "bake/scene_pieces.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace
{

using namespace frontalis;

/// A block of 20 x 12 x 8 mm whose lower corner is the origin, and thin plates at its faces.
Scene block_scene()
{
  Scene scene = plain_scene(1e-3);
  scene.surfaces = { box_surface("block", { 10e-3, 6e-3, 4e-3 }, { 20e-3, 12e-3, 8e-3 }),
                     box_surface("floor", { 10e-3, 6e-3, -1e-3 }, { 60e-3, 60e-3, 2e-3 }),
                     box_surface("roof", { 10e-3, 6e-3, 9.3e-3 }, { 60e-3, 60e-3, 2e-3 }) };
  scene.volumes = { volume_inside("tissue", { "block" }, "fat", true) };
  return scene;
}

SceneConstraint constraint(const std::string& name, SceneConstraint::Kind kind, const std::string& surface)
{
  SceneConstraint out;
  out.name = name;
  out.kind = kind;
  out.surfaces = { surface };
  out.line = 9;
  return out;
}

TEST(RestrictedNodes, RigidFloorSlidingRoof)
{
  Scene scene = block_scene();
  scene.constraints = { constraint("hold", SceneConstraint::Kind::rigid, "floor"),
                        constraint("glide", SceneConstraint::Kind::sliding, "roof") };
  scene.constraints[0].bone = "skull";
  const Model model = bake(scene);
  ASSERT_EQ(model.bones, std::vector<std::string>{ "skull" });
  ASSERT_EQ(model.rigid.size(), 21u * 13u);
  for (const RigidNode& node : model.rigid)
  {
    EXPECT_NEAR(transformed(model.to_scene, node_position(model, node.node))[2], 0, 1e-12);
    EXPECT_EQ(node.bone, 0);
    EXPECT_EQ(model.constraints.at(static_cast<std::size_t>(node.constraint)), "hold");
  }
  // the lower side of `roof` is 0.3 mm above the tissue and faces it
  ASSERT_EQ(model.sliding.size(), 21u * 13u);
  for (const SlidingNode& node : model.sliding)
  {
    EXPECT_NEAR(transformed(model.to_scene, node_position(model, node.node))[2], 8e-3, 1e-12);
    EXPECT_NEAR(node.distance, 0.3e-3, 1e-10);
    EXPECT_EQ(model.constraints.at(static_cast<std::size_t>(node.constraint)), "glide");
  }
  ASSERT_EQ(model.constraint_surfaces.size(), 1u);
  EXPECT_EQ(model.constraint_surfaces[0].name, "roof");
}

// Two bones with a gap of 0.4 mm and a step of 0.2 mm between them.
TEST(RestrictedNodes, SlideFromOneBoneToTheNext)
{
  Scene scene = block_scene();
  scene.surfaces.push_back(box_surface("left", { -10.2e-3, 6e-3, -5e-3 }, { 40e-3, 60e-3, 10e-3 }, 1e-3));
  scene.surfaces.push_back(box_surface("right", { 30.2e-3, 6e-3, -5.2e-3 }, { 40e-3, 60e-3, 10e-3 }, 1e-3));
  scene.constraints = { constraint("glide", SceneConstraint::Kind::sliding, "left") };
  scene.constraints[0].surfaces = { "left", "right" };
  const Model model = bake(scene);
  EXPECT_EQ(model.sliding.size(), 21u * 13u);
  ASSERT_EQ(model.constraint_surfaces.size(), 1u);
  EXPECT_EQ(model.constraint_surfaces[0].name, "left, right");
  const auto local = [&](const std::array<double, 3>& p)
  {
    std::array<double, 3> q{};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        q[i] += model.to_scene.rotation[3 * j + i] * (p[j] - model.to_scene.translation[j]);
    return q;
  };
  for (const double z : { 0.0, -0.2e-3, 0.4e-3 })
  {
    double before = z;
    for (double x = 4e-3; x < 16e-3; x += 0.1e-3)
    {
      const double level = level_at(model.constraint_surfaces[0].field, local({ { x, 6e-3, z } }));
      EXPECT_GT(level, z - 0.03e-3) << x;
      EXPECT_LT(level, z + 0.23e-3) << x;
      EXPECT_LT(std::abs(level - before), 0.03e-3) << x;
      before = level;
    }
    EXPECT_NEAR(before, z + 0.2e-3, 0.01e-3);
  }
}

TEST(RestrictedNodes, NodesBeyondTheSurfaceCount)
{
  // the bone's surface cuts voxels, whose lower nodes are in the bone
  Scene scene = block_scene();
  scene.surfaces.push_back(box_surface("bone", { 10e-3, 6e-3, 0 }, { 60e-3, 60e-3, 5e-3 }));
  scene.volumes[0].outside = { "bone" };
  scene.constraints = { constraint("hold", SceneConstraint::Kind::rigid, "bone") };
  scene.constraints[0].within = 0.1e-3;
  const Model model = bake(scene);
  std::set<double> heights;
  for (const RigidNode& node : model.rigid)
    heights.insert(std::round(1e6 * transformed(model.to_scene, node_position(model, node.node))[2]));
  // the bone ends at 2.5 mm, in the middle of voxels, whose lower nodes are rigid and whose upper ones are free
  EXPECT_EQ(heights.size(), 1u);
  EXPECT_EQ(model.rigid.size(), 21u * 13u);
}

TEST(RestrictedNodes, RigidWinsOverPrescribedOverSliding)
{
  Scene scene = block_scene();
  scene.constraints = { constraint("glide", SceneConstraint::Kind::sliding, "floor"),
                        constraint("hold", SceneConstraint::Kind::rigid, "floor") };
  scene.constraints[1].crop.upper[0] = 5.1e-3;
  SceneLoad load;
  load.name = "stretch";
  load.kind = SceneLoad::Kind::displacement;
  load.surface = "floor";
  load.value = { 0, 0, 2e-3 };
  load.fixed = { false, false, true };
  load.crop.upper[0] = 9.1e-3;
  scene.loads = { load };
  const Model model = bake(scene);
  EXPECT_EQ(model.rigid.size(), 6u * 13u);
  EXPECT_EQ(model.prescribed.size(), 4u * 13u);
  EXPECT_EQ(model.sliding.size(), 11u * 13u);
  // loads are in local axes
  ASSERT_EQ(model.loads.size(), 1u);
  for (std::size_t a = 0; a < 3; ++a)
  {
    EXPECT_EQ(model.loads[0].fixed[a], model.to_scene.rotation[6 + a] == 1);
    EXPECT_EQ(model.loads[0].value[a], 2e-3 * model.to_scene.rotation[6 + a]);
  }
  // a load that moves nothing, and two that move the same nodes
  scene.loads[0].crop.upper[0] = 5.1e-3;
  BakeReport report;
  bake(scene, &report);
  EXPECT_THAT(report.warnings, testing::Contains(testing::HasSubstr("load 'stretch' moves nothing")));
  scene.loads = { load, load };
  scene.loads[1].name = "again";
  bake(scene, &report);
  EXPECT_THAT(report.warnings,
              testing::Contains(testing::HasSubstr("load 'again' moves 52 nodes that another load moves as well")));
}

TEST(RestrictedNodes, AConstraintThatCatchesNothingIsNamed)
{
  Scene scene = block_scene();
  scene.surfaces.push_back(box_surface("away", { 10e-3, 6e-3, 90e-3 }, { 5e-3, 5e-3, 5e-3 }));
  scene.constraints = { constraint("hold", SceneConstraint::Kind::rigid, "away") };
  const std::string fault = fault_of(scene);
  EXPECT_NE(fault.find("test.yaml:9: constraint 'hold'"), std::string::npos) << fault;
}

TEST(Islands, UnheldAndCornerHungPartsAreRemoved)
{
  Scene scene = plain_scene(1e-3);
  // the scene: a block, another one that touches only its edge, a separate one with held nodes, and a separate free one
  scene.surfaces = { box_surface("block", { 10e-3, 10e-3, 10e-3 }, { 20e-3, 20e-3, 20e-3 }),
                     box_surface("edge", { 21e-3, 10e-3, 21e-3 }, { 2e-3, 4e-3, 2e-3 }),
                     box_surface("held", { 40e-3, 10e-3, 5e-3 }, { 10e-3, 10e-3, 10e-3 }),
                     box_surface("loose", { 60e-3, 10e-3, 5e-3 }, { 10e-3, 10e-3, 10e-3 }),
                     box_surface("floor", { 25e-3, 10e-3, -1e-3 }, { 50e-3, 60e-3, 2e-3 }) };
  scene.volumes = { volume_inside("tissue", { "block", "edge", "held", "loose" }, "fat", true) };
  scene.constraints = { constraint("hold", SceneConstraint::Kind::rigid, "floor") };
  BakeReport report;
  const Model model = bake(scene, &report);
  EXPECT_EQ(model.voxels.size(), 8000u + 1000u);
  bool reported = false;
  for (const std::string& finding : report.findings)
    reported = reported || finding.find("1016 voxels removed: 2 islands") != std::string::npos;
  EXPECT_TRUE(reported);
  EXPECT_EQ(model.rigid.size(), 21u * 21u + 11u * 11u);
  for (const RigidNode& node : model.rigid)
    EXPECT_NEAR(transformed(model.to_scene, node_position(model, node.node))[2], 0, 1e-12);
}

}  // namespace

TEST(Loads, OnAHollowAreCarriedByTheTissueAroundIt)
{
  Scene scene = plain_scene(2e-3);
  scene.accuracy.fill_min = 0.2;
  scene.surfaces = { sphere_surface("skin", { 0, 0, 0 }, 30e-3, 2e-3),
                     sphere_surface("hollow", { 0, 0, 0 }, 20e-3, 1e-3) };
  scene.volumes = { volume_inside("tissue", { "skin" }, "fat", true) };
  Region eighth;
  eighth.lower = { 0, 0, 0 };
  scene.volumes[0].crop = eighth;
  SceneLoad load;
  load.name = "pressure";
  load.kind = SceneLoad::Kind::pressure;
  load.surface = "hollow";
  load.crop = eighth;
  load.value = { 10, 0, 0 };
  scene.loads = { load };
  for (const bool outside : { true, false })
  {
    Volume& tissue = scene.volumes[0];
    (outside ? tissue.outside : tissue.without) = { "hollow" };
    (outside ? tissue.without : tissue.outside).clear();
    const Model model = bake(scene);
    ASSERT_EQ(model.loads.size(), 1u);
    // The cells in which the hollow touches a plane of the grid have hardly any tissue; the next voxels above carry it.
    for (const auto& coordinates : model.loads[0].binding.coordinates)
      for (const float c : coordinates)
        EXPECT_TRUE(c > -0.5f && c < 1.5f) << c;
    // The pressure presses on the tissue: the normals point to the middle of the hollow.
    double volume = 0;
    for (const auto& t : model.loads[0].mesh.triangles)
    {
      std::array<std::array<double, 3>, 3> v{};
      for (int c = 0; c < 3; ++c)
        v[c] = transformed(model.to_scene, model.loads[0].mesh.vertices[t[c]]);
      volume += (v[0][0] * (v[1][1] * v[2][2] - v[1][2] * v[2][1]) + v[0][1] * (v[1][2] * v[2][0] - v[1][0] * v[2][2]) +
                 v[0][2] * (v[1][0] * v[2][1] - v[1][1] * v[2][0])) /
                6;
    }
    EXPECT_NEAR(volume, -M_PI / 6 * std::pow(20e-3, 3), 0.02 * 4e-6);
  }
}

/// A ball of tissue with air in a hollow of 12 mm radius, and a bone of 10 mm radius about (x, 0, 0) [m].
Scene pressed_hollow(double x)
{
  Scene scene = plain_scene(2e-3);
  scene.surfaces = { sphere_surface("skin", { 0, 0, 0 }, 30e-3, 2e-3),
                     sphere_surface("hollow", { 0, 0, 0 }, 12e-3, 1e-3),
                     sphere_surface("bone", { x, 0, 0 }, 10e-3, 1e-3) };
  scene.volumes = { volume_inside("tissue", { "skin" }, "fat", true) };
  scene.volumes[0].without = { "hollow" };
  scene.volumes[0].outside = { "bone" };
  SceneLoad load;
  load.name = "pressure";
  load.kind = SceneLoad::Kind::pressure;
  load.surface = "hollow";
  load.value = { 10, 0, 0 };
  scene.loads = { load };
  return scene;
}

TEST(Loads, ActOnTheWholeOfATriangle)
{
  Scene scene = block_scene();
  SceneLoad load;
  load.name = "pull";
  load.kind = SceneLoad::Kind::traction;
  load.surface = "block";
  load.value = { 10, 0, 0 };
  load.crop.lower[0] = 19.9e-3;  // the end, a square of 2 triangles in the file, and 0.1 mm of its sides
  scene.loads = { load };
  const TriangleMesh mesh = bake(scene).loads.at(0).mesh;
  double longest = 0, area = 0;
  for (const auto& t : mesh.triangles)
  {
    const Vector3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const auto to = [](const Vector3& from, const Vector3& p) {
      return Vector3{ p[0] - from[0], p[1] - from[1], p[2] - from[2] };
    };
    const Vector3 u = to(a, b), v = to(a, c), w = to(b, c);
    area += 0.5 * std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
    for (const Vector3& side : { u, v, w })
      longest = std::max(longest, std::hypot(side[0], side[1], side[2]));
  }
  EXPECT_LT(longest, 1.001e-3) << "a voxel's edge";
  EXPECT_NEAR(area, 12e-3 * 8e-3 + 0.1e-3 * 2 * (12e-3 + 8e-3), 1e-9);
}

TEST(Loads, SpareTrianglesThatHaveNoTissueBehindThem)
{
  const Scene scene = pressed_hollow(12e-3);
  const Model model = bake(scene);
  ASSERT_EQ(model.loads.size(), 1u);
  double deepest = 0, farthest = 0;
  for (const auto& vertex : model.loads[0].mesh.vertices)
  {
    const auto p = transformed(model.to_scene, vertex);
    deepest = std::max(deepest, 10e-3 - std::hypot(p[0] - 12e-3, p[1], p[2]));
    farthest = std::max(farthest, -p[0]);
  }
  EXPECT_LT(deepest, 4e-3);  // the hollow reaches 10 mm into the bone
  EXPECT_NEAR(farthest, 12e-3, 0.1e-3);
}

TEST(Loads, SpareTrianglesNearSurfacesOfWhichTheyAreToBeClear)
{
  Scene scene = pressed_hollow(25e-3);
  scene.loads[0].clear_of = { "bone" };
  scene.loads[0].clearance = 5e-3;
  const Model model = bake(scene);
  ASSERT_EQ(model.loads.size(), 1u);
  double nearest = 1, farthest = 0;
  for (const auto& vertex : model.loads[0].mesh.vertices)
  {
    const auto p = transformed(model.to_scene, vertex);
    nearest = std::min(nearest, std::hypot(p[0] - 25e-3, p[1], p[2]) - 10e-3);
    farthest = std::max(farthest, -p[0]);
  }
  EXPECT_GE(nearest, 4.9e-3);  // the bone has facets; without clearance it would be 3 mm
  EXPECT_LT(nearest, 6.5e-3);
  EXPECT_NEAR(farthest, 12e-3, 0.1e-3);
}
