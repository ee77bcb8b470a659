#include "frontalis/model/sample_field.hpp"

#include "bake/scene_pieces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace
{

using namespace frontalis;

constexpr double radius = 30.37e-3;

/// An eighth of a layer of thickness `depth` on a ball. `kind`: whether it is held or slides.
Scene layer_scene(double depth, SceneConstraint::Kind kind)
{
  Scene scene = plain_scene(2e-3);
  scene.accuracy.fill_min = 0.2;
  scene.accuracy.boundary = "true";
  scene.surfaces = { sphere_surface("ball", { 0, 0, 0 }, radius, 1e-3),
                     sphere_surface("skin", { 0, 0, 0 }, radius + depth, 1e-3) };
  scene.volumes = { volume_inside("tissue", { "skin" }, "fat", true) };
  scene.volumes[0].outside = { "ball" };
  scene.volumes[0].crop.lower = { 0, 0, 0 };
  SceneConstraint constraint;
  constraint.name = "bone";
  constraint.kind = kind;
  constraint.surfaces = { "ball" };
  scene.constraints = { constraint };
  return scene;
}

Vector3 scene_position(const Model& model, std::int32_t node)
{
  return transformed(model.to_scene, node_position(model, node));
}

double height(const Model& model, std::int32_t node)
{
  const Vector3 p = scene_position(model, node);
  return std::hypot(p[0], p[1], p[2]) - radius;
}

template <class Restricted>
std::set<std::int32_t> nodes_of(const std::vector<Restricted>& list)
{
  std::set<std::int32_t> nodes;
  for (const Restricted& entry : list)
    nodes.insert(entry.node);
  return nodes;
}

double smallest_fill(const Model& model) { return *std::min_element(model.fill.begin(), model.fill.end()); }

}  // namespace

TEST(AttachedNodes, FollowFreeNodesAboveTheSurface)
{
  for (const auto kind : { SceneConstraint::Kind::rigid, SceneConstraint::Kind::sliding })
  {
    Scene scene = layer_scene(8e-3, kind);
    const Model model = bake(scene);
    EXPECT_TRUE(model.rigid.empty());
    EXPECT_TRUE(model.sliding.empty());
    const std::set<std::int32_t> attached = nodes_of(model.attached);
    for (const AttachedNode& node : model.attached)
    {
      const double own = height(model, node.node), of_master = height(model, node.master);
      EXPECT_LT(own, 1.51e-3);
      EXPECT_GT(of_master, 1e-3);
      EXPECT_NEAR(node.ratio, std::max(-1.0, own / of_master), 0.02) << "the ball's mesh is a little smaller";
      EXPECT_EQ(node.surface, kind == SceneConstraint::Kind::rigid ? -1 : 0);
      EXPECT_EQ(model.constraints.at(static_cast<std::size_t>(node.constraint)), "bone");
    }
    for (const AttachedNode& node : model.attached)
      EXPECT_EQ(attached.count(node.master), 0u);
    for (std::int32_t n = 0; n < static_cast<std::int32_t>(model.nodes.size()); ++n)
      EXPECT_EQ(attached.count(n) > 0, height(model, n) < 1.5e-3) << "height " << height(model, n);

    scene.accuracy.boundary = "staircase";
    const Model staircase = bake(scene);
    EXPECT_TRUE(staircase.attached.empty());
    EXPECT_GE(smallest_fill(staircase), 0.2F);
    EXPECT_LT(smallest_fill(model), 0.1F) << "no voxel is dropped at the bone";
  }
}

// The mean of the centroids of all voxels, weighted by their tissue, is the centroid of the body. For an eighth of a
// shell between the radii a and b that is 3/8 (b^4 - a^4) / (b^3 - a^3) along each axis.
TEST(CutVoxels, KnowTheCentroidsOfTheirTissue)
{
  const Model model = bake(layer_scene(8e-3, SceneConstraint::Kind::rigid));
  ASSERT_EQ(model.tissue_centre.size(), model.voxels.size());
  Vector3 sum{};
  double tissue = 0, from_centres = 0;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    Vector3 p;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      const double centre = double(model.tissue_centre[e][axis]);
      p[axis] = (model.voxels[e][axis] + 0.5 + 0.5 * centre) * model.spacing[axis];
      from_centres += std::abs(centre);
      EXPECT_TRUE(centre == 0 || model.fill[e] < 1);
    }
    const Vector3 at = transformed(model.to_scene, p);
    for (std::size_t axis = 0; axis < 3; ++axis)
      sum[axis] += model.fill[e] * at[axis];
    tissue += model.fill[e];
    const double height_of_centre = std::hypot(at[0], at[1], at[2]) - radius;
    EXPECT_GT(height_of_centre, -0.3e-3);
    EXPECT_LT(height_of_centre, 8.3e-3);
  }
  EXPECT_GT(from_centres, 100);
  const double a = radius, b = radius + 8e-3;
  const double exact = 0.375 * (std::pow(b, 4) - std::pow(a, 4)) / (std::pow(b, 3) - std::pow(a, 3));
  for (const double x : sum)
    EXPECT_NEAR(x / tissue, exact, 0.05e-3);
  Scene staircase = layer_scene(8e-3, SceneConstraint::Kind::rigid);
  staircase.accuracy.boundary = "staircase";
  EXPECT_TRUE(bake(staircase).tissue_centre.empty());
}

TEST(AttachedNodes, FollowLowNodes)
{
  for (const auto kind : { SceneConstraint::Kind::rigid, SceneConstraint::Kind::sliding })
  {
    const Model model = bake(layer_scene(8e-3, kind));
    double sum = 0;
    for (const AttachedNode& node : model.attached)
    {
      const double of_master = height(model, node.master);
      sum += of_master;
      EXPECT_LT(of_master, 4e-3);
      // The master is less than the diagonal of a voxel's face beside the nearest point of the surface.
      const Vector3 own = scene_position(model, node.node), other = scene_position(model, node.master);
      double along = 0;
      for (std::size_t a = 0; a < 3; ++a)
        along += own[a] * other[a] / std::hypot(own[0], own[1], own[2]);
      EXPECT_LT(std::sqrt(std::pow(of_master + radius, 2) - along * along), 2.9e-3);
    }
    EXPECT_LT(sum / static_cast<double>(model.attached.size()), 2.5e-3);
  }
}

TEST(AttachedNodes, NeedLittleMoreThanAVoxelOfTissue)
{
  for (const auto kind : { SceneConstraint::Kind::rigid, SceneConstraint::Kind::sliding })
  {
    BakeReport report;
    const Model model = bake(layer_scene(2.4e-3, kind), &report);
    EXPECT_FALSE(model.attached.empty());
    EXPECT_TRUE(model.rigid.empty());
    EXPECT_TRUE(model.sliding.empty());
    EXPECT_TRUE(std::none_of(report.findings.begin(), report.findings.end(),
                             [](const std::string& finding) { return finding.rfind("boundary: tissue", 0) == 0; }));
  }
}

// A constraint attaches tissue at the part of its surface that lies in its crop, wherever the nodes above and below
// that part are.
TEST(AttachedNodes, AreThoseOfTheSurfaceInTheCrop)
{
  const double edge = 0.8 * radius;
  Scene scene = layer_scene(8e-3, SceneConstraint::Kind::sliding);
  SceneConstraint held = scene.constraints[0];
  held.name = "held";
  held.kind = SceneConstraint::Kind::rigid;
  held.crop.lower[2] = scene.constraints[0].crop.upper[2] = edge;
  scene.constraints.push_back(held);
  const Model model = bake(scene);
  EXPECT_TRUE(model.rigid.empty());
  EXPECT_TRUE(model.sliding.empty());
  std::size_t across = 0;  // nodes that are on the other side of the crop's plane than their points on the surface
  for (const AttachedNode& node : model.attached)
  {
    const Vector3 p = scene_position(model, node.node);
    const double on_surface = p[2] * radius / std::hypot(p[0], p[1], p[2]);
    if (std::abs(on_surface - edge) < 0.02e-3)
      continue;
    const bool above = on_surface > edge;
    EXPECT_EQ(node.surface < 0, above) << on_surface << " " << p[2];
    across += (p[2] > edge) != above ? 1 : 0;
  }
  EXPECT_GT(across, 5u);

  // What is restricted where it is has its own place in the crop.
  scene.accuracy.boundary = "staircase";
  const Model staircase = bake(scene);
  EXPECT_FALSE(staircase.rigid.empty());
  for (const RigidNode& node : staircase.rigid)
    EXPECT_GE(scene_position(staircase, node.node)[2], edge);
  EXPECT_FALSE(staircase.sliding.empty());
  for (const SlidingNode& node : staircase.sliding)
    EXPECT_LE(scene_position(staircase, node.node)[2], edge);
}

// Tissue in one sheet of voxels, whose nodes are at 0 and 2 mm, has no masters where its upper nodes are less than 0.75
// edges above the bone. More than half an edge above it they are free, and the lower nodes are held.
TEST(AttachedNodes, AreHeldOrFreeWhereTissueIsTooThin)
{
  for (const double bone_top : { 0.55e-3, 0.95e-3 })
  {
    Scene scene = layer_scene(8e-3, SceneConstraint::Kind::rigid);
    scene.surfaces = { box_surface("skull", { 10e-3, 10e-3, bone_top - 3e-3 }, { 60e-3, 60e-3, 6e-3 }),
                       box_surface("skin", { 10e-3, 10e-3, 0.95e-3 }, { 20e-3, 20e-3, 1.9e-3 }) };
    scene.volumes[0].outside = scene.constraints[0].surfaces = { "skull" };
    BakeReport report;
    const Model model = bake(scene, &report);
    EXPECT_TRUE(model.attached.empty());
    const std::set<std::int32_t> held = nodes_of(model.rigid);
    std::size_t above = 0;
    for (std::int32_t n = 0; n < static_cast<std::int32_t>(model.nodes.size()); ++n)
    {
      const double over_bone = scene_position(model, n)[2] - bone_top;
      above += over_bone > 0 ? 1 : 0;
      EXPECT_LT(over_bone, 1.5e-3);
      EXPECT_EQ(held.count(n) > 0, over_bone < 0) << "height " << over_bone;
    }
    EXPECT_EQ(above, 121u);
    EXPECT_EQ(model.nodes.size(), 242u);
    EXPECT_TRUE(std::any_of(report.findings.begin(), report.findings.end(),
                            [](const std::string& finding)
                            {
                              return finding.rfind("boundary: tissue", 0) == 0 &&
                                     finding.find("held there (121), the others are free (121)") != std::string::npos;
                            }));
  }
}

// The nodes of other constraints stay where they are, and are those in the crop.
TEST(AttachedNodes, AreThoseOfConstraintsWithoutADistanceOfTheirOwnOrFriction)
{
  const double edge = 0.8 * radius;
  Scene scene = layer_scene(8e-3, SceneConstraint::Kind::rigid);
  scene.constraints[0].within = 1e-3;
  scene.constraints[0].crop.lower[2] = edge;
  const Model within = bake(scene);
  EXPECT_TRUE(within.attached.empty());
  EXPECT_FALSE(within.rigid.empty());
  for (const RigidNode& node : within.rigid)
    EXPECT_GE(scene_position(within, node.node)[2], edge);
  scene = layer_scene(8e-3, SceneConstraint::Kind::sliding);
  scene.constraints[0].friction = 0.2;
  scene.constraints[0].crop.lower[2] = edge;
  const Model friction = bake(scene);
  EXPECT_TRUE(friction.attached.empty());
  EXPECT_FALSE(friction.sliding.empty());
  for (const SlidingNode& node : friction.sliding)
    EXPECT_GE(scene_position(friction, node.node)[2], edge);
  EXPECT_GE(smallest_fill(friction), 0.2F) << "no cut voxel is kept for nodes that are not attached";
}

TEST(AttachedNodes, SwitchedOffStayHeldOrSlideWhereTheyAre)
{
  for (const auto kind : { SceneConstraint::Kind::rigid, SceneConstraint::Kind::sliding })
  {
    Scene scene = layer_scene(8e-3, kind);
    scene.constraints[0].crop.lower[2] = 0.8 * radius;
    const std::set<std::int32_t> attached = nodes_of(bake(scene).attached);
    scene.switched_off = EffectSet().with(Effect::attachment);
    const Model model = bake(scene);
    EXPECT_TRUE(model.attached.empty());
    EXPECT_FALSE(attached.empty());
    EXPECT_EQ(kind == SceneConstraint::Kind::rigid ? nodes_of(model.rigid) : nodes_of(model.sliding), attached);
    EXPECT_FALSE(model.tissue_centre.empty());
  }
}
