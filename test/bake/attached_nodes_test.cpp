#include "frontalis/model/sample_field.hpp"

#include "bake/scene_pieces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace
{

using namespace frontalis;

constexpr double radius = 30.37e-3;

/// An eighth of a layer on a ball, `depth` thick, held or sliding.
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
