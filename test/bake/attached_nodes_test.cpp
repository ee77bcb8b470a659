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

double height(const Model& model, std::int32_t node)
{
  const Vector3 p = transformed(model.to_scene, node_position(model, node));
  return std::hypot(p[0], p[1], p[2]) - radius;
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
    std::set<std::int32_t> attached;
    for (const AttachedNode& node : model.attached)
    {
      attached.insert(node.node);
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

TEST(AttachedNodes, AreHeldWhereTissueIsTooThin)
{
  BakeReport report;
  const Model model = bake(layer_scene(2e-3, SceneConstraint::Kind::rigid), &report);
  EXPECT_FALSE(model.rigid.empty());
  for (const RigidNode& node : model.rigid)
    EXPECT_LT(height(model, node.node), 1.01e-3);
  EXPECT_TRUE(std::any_of(report.findings.begin(), report.findings.end(),
                          [](const std::string& finding) { return finding.rfind("boundary: tissue", 0) == 0; }));
}

TEST(AttachedNodes, AreThoseOfConstraintsWithoutADistanceOfTheirOwnOrFriction)
{
  Scene scene = layer_scene(8e-3, SceneConstraint::Kind::rigid);
  scene.constraints[0].within = 1e-3;
  const Model within = bake(scene);
  EXPECT_TRUE(within.attached.empty());
  EXPECT_FALSE(within.rigid.empty());
  scene = layer_scene(8e-3, SceneConstraint::Kind::sliding);
  scene.constraints[0].friction = 0.2;
  const Model friction = bake(scene);
  EXPECT_TRUE(friction.attached.empty());
  EXPECT_FALSE(friction.sliding.empty());
}

TEST(AttachedNodes, SwitchedOffStayHeldOrSlideWhereTheyAre)
{
  for (const auto kind : { SceneConstraint::Kind::rigid, SceneConstraint::Kind::sliding })
  {
    Scene scene = layer_scene(8e-3, kind);
    const std::size_t attached = bake(scene).attached.size();
    scene.switched_off = EffectSet().with(Effect::attachment);
    const Model model = bake(scene);
    EXPECT_TRUE(model.attached.empty());
    EXPECT_EQ(model.rigid.size() + model.sliding.size(), attached);
    EXPECT_FALSE(model.tissue_centre.empty());
  }
}
