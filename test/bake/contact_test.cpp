// The bake of bodies that tissue touches, and of the points of the tissue that may touch them.

#include "frontalis/error.hpp"
#include "frontalis/model/effects.hpp"
#include "frontalis/model/model_file.hpp"
#include "frontalis/model/sample_field.hpp"

#include "bake/scene_pieces.hpp"
#include "files.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace
{

using namespace frontalis;

/// A block of 20 x 12 x 8 mm whose lower corner is the origin, and a body 1 mm above its upper side.
Scene touched_block()
{
  Scene scene = plain_scene(1e-3);
  scene.surfaces = { box_surface("block", { 10e-3, 6e-3, 4e-3 }, { 20e-3, 12e-3, 8e-3 }),
                     box_surface("plate", { 10e-3, 6e-3, 12e-3 }, { 10e-3, 8e-3, 6e-3 }),
                     sphere_surface("ball", { 10e-3, 6e-3, 14e-3 }, 5e-3) };
  scene.volumes = { volume_inside("tissue", { "block" }, "fat", true) };
  SceneConstraint touch;
  touch.name = "touch";
  touch.kind = SceneConstraint::Kind::contact;
  touch.surfaces = { "ball" };
  touch.on = "block";
  touch.bone = "finger";
  touch.friction = 0.3;
  touch.crop.lower[2] = 7.9e-3;
  touch.line = 9;
  scene.constraints = { touch };
  return scene;
}

std::array<double, 3> local(const Model& model, const std::array<double, 3>& scene)
{
  std::array<double, 3> p{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      p[i] += model.to_scene.rotation[3 * j + i] * (scene[j] - model.to_scene.translation[j]);
  return p;
}

TEST(BakedContact, ASphereIsExactAndPointsHaveTheAreaOfTheSurface)
{
  const Model model = bake(touched_block());
  ASSERT_EQ(model.contacts.size(), 1u);
  const Contact& contact = model.contacts[0];
  EXPECT_EQ(contact.name, "touch");
  EXPECT_EQ(model.bones, std::vector<std::string>{ "finger" });
  EXPECT_EQ(contact.bone, 0);
  EXPECT_EQ(contact.friction, 0.3);
  EXPECT_TRUE(contact.field.samples.empty());
  EXPECT_NEAR(level_at(contact.field, local(model, { 10e-3, 6e-3, 8e-3 })), 1e-3, 1e-12);
  // the points represent the upper side, and strips of 0.1 mm of the sides next to it
  EXPECT_NEAR(std::accumulate(contact.area.begin(), contact.area.end(), 0.0), 240e-6 + 64e-3 * 0.1e-3, 1e-9);
  // the bake has divided the surface's large triangles
  EXPECT_GT(contact.points.size(), 21u * 13u);
  EXPECT_TRUE(effects_of(model).has(Effect::contact));
  EXPECT_EQ(model.constraints, std::vector<std::string>{ "touch" });
}

TEST(BakedContact, OtherBodiesAreSampledAsOneAroundTheirSurfaces)
{
  Scene scene = touched_block();
  scene.constraints[0].surfaces = { "plate", "ball" };
  const Model model = bake(scene);
  const SampledField& field = model.contacts[0].field;
  EXPECT_EQ(field.radius, 0);
  EXPECT_NEAR(field.spacing, 0.5e-3, 1e-15);
  EXPECT_NEAR(model.contacts[0].reach, 2e-3, 1e-15);
  for (const double z : { 7.1e-3, 8e-3, 8.9e-3, 9.2e-3, 10.9e-3 })
    EXPECT_NEAR(level_at(field, local(model, { 7.5e-3, 6e-3, z })), 9e-3 - z, 0.03e-3) << z;
  // the field covers the inside of a body
  EXPECT_LT(level_at(field, local(model, { 10e-3, 6e-3, 16e-3 })), -2.5e-3);
  // at this height only the ball has samples
  EXPECT_NEAR(level_at(field, local(model, { 10e-3, 6e-3, 20e-3 })), 1e-3, 0.05e-3);
  EXPECT_TRUE(std::isnan(level_at(field, local(model, { 10e-3, 6e-3, 60e-3 }))));
}

TEST(BakedContact, WhatCannotBeIsRefused)
{
  Scene scene = touched_block();
  scene.constraints[0].on = "ball";
  scene.surfaces[2].shape->centre[2] = 24e-3;
  EXPECT_EQ(fault_of(scene).find("test.yaml:9: constraint 'touch': no triangle of surface 'ball' lies in its crop"), 0u)
      << fault_of(scene);
  scene = touched_block();
  scene.surfaces[2].shape->centre[2] = 12e-3;
  EXPECT_EQ(fault_of(scene).find("test.yaml:9: constraint 'touch': at rest its surface lies"), 0u) << fault_of(scene);
  scene = touched_block();
  const TemporaryFolder folder;
  const TriangleMesh mesh{ { { { 0, 0, 12e-3 } }, { { 9e-3, 0, 12e-3 } }, { { 0, 9e-3, 12e-3 } } },
                           { { { 0, 1, 2 } } } };
  write_obj(mesh, folder / "sheet.obj", [](const auto&) { return true; });
  scene.surfaces.push_back(file_surface("sheet", folder / "sheet.obj"));
  scene.constraints[0].surfaces = { "sheet" };
  EXPECT_EQ(fault_of(scene).find("test.yaml:9: constraint 'touch': surface 'sheet' is open"), 0u) << fault_of(scene);
}

TEST(BakedContact, WhatIsOnlyShownContinuesTheSkinAndTouchesNothing)
{
  Scene scene = touched_block();
  scene.skin.surface = "block";
  scene.skin.crop.lower = { 3.1e-3, -1, -1 };
  scene.skin.crop.upper[2] = 5.3e-3;
  SceneConstraint& shown = scene.constraints[0];
  shown.surfaces = { "block" };
  shown.within = 0;
  const Model model = bake(scene);
  ASSERT_EQ(model.contacts.size(), 1u);
  const Contact& contact = model.contacts[0];
  EXPECT_TRUE(contact.points.empty());
  EXPECT_FALSE(effects_of(model).has(Effect::contact));
  const auto area = [](const TriangleMesh& mesh)
  {
    const std::vector<double> areas = vertex_areas(mesh);
    return std::accumulate(areas.begin(), areas.end(), 0.0);
  };
  const double whole = 2 * (20e-3 * 12e-3 + 12e-3 * 8e-3 + 8e-3 * 20e-3);
  EXPECT_NEAR(area(model.skin) + area(contact.shape), whole, 1e-9 * whole);
  // each point of the skin's edge is one of the rest
  int seam = 0;
  for (const auto& vertex : model.skin.vertices)
  {
    const auto p = model.to_scene(vertex);
    if (std::abs(p[0] - 3.1e-3) > 1e-9 && std::abs(p[2] - 5.3e-3) > 1e-9)
      continue;
    double apart = 1;
    for (const auto& other : contact.shape.vertices)
      apart = std::min(apart, std::hypot(other[0] - vertex[0], other[1] - vertex[1], other[2] - vertex[2]));
    EXPECT_LT(apart, 1e-12);
    ++seam;
  }
  EXPECT_GE(seam, 8);
}

TEST(BakedContact, WhatIsOnlyShownGoesOnBelowTheSkinInItsCrop)
{
  Scene scene = touched_block();
  scene.surfaces[0].shape->edge = 2e-3;
  scene.skin.surface = "block";
  scene.skin.crop.lower[0] = 3.1e-3;
  SceneConstraint& shown = scene.constraints[0];
  shown.surfaces = { "block" };
  shown.within = 0;
  shown.crop = Region{};
  shown.crop.upper[0] = 5.1e-3;
  // The side z = 0 of the block goes on above itself, higher by 0.12 of the distance from the side of the skin's crop.
  const Model model = bake(scene);
  double farthest = 0;
  for (const auto& vertex : model.contacts[0].shape.vertices)
  {
    const auto p = model.to_scene(vertex);
    if (p[0] < 3.1e-3 || std::abs(p[1] - 6e-3) > 3e-3 || p[2] > 4e-3)
      continue;
    EXPECT_NEAR(p[2], 0.12 * (p[0] - 3.1e-3), 1e-9) << p[0] << " " << p[1];
    farthest = std::max(farthest, p[0]);
  }
  EXPECT_NEAR(farthest, 5.1e-3, 1e-9);
}

TEST(BakedContact, ACropOfWhatIsOnlyShownNeedsASkinThatIsCroppedToo)
{
  Scene scene = touched_block();
  scene.skin.surface = "block";
  scene.constraints[0].surfaces = { "block" };
  scene.constraints[0].within = 0;
  const std::string place = "test.yaml:9: constraint 'touch': 'crop' ";
  EXPECT_EQ(fault_of(scene).find(place + "shows a part of 'block' below the skin, but the skin has no crop"), 0u)
      << fault_of(scene);
  scene.skin.crop.upper[2] = 5.3e-3;
  EXPECT_EQ(fault_of(scene), "");
  scene.constraints[0].surfaces = { "plate", "ball" };
  EXPECT_EQ(
      fault_of(scene).find(place + "stands beside 'plate', 'ball'; it takes a part of the skin's surface, 'block'"), 0u)
      << fault_of(scene);
}

TEST(BakedContact, AFileGivesItBackAndHoldsNothingWithoutIt)
{
  const TemporaryFolder folder;
  const auto bytes_of = [&](const Model& model)
  {
    write_model(model, folder / "model.vtkhdf");
    return text_of(folder / "model.vtkhdf");
  };
  Scene scene = touched_block();
  scene.constraints[0].surfaces = { "plate" };
  scene.constraints[0].pushed = ScenePush{ 0.02, { 0, 0, -1 }, 200, 3 };
  scene.demo.push_back({ "", { { "finger", { 1e-3, 0, 0 }, { 0, 0.1, 0 } } }, 0.1, 1 });
  Model model = bake(scene);
  const std::string whole = bytes_of(model);
  EXPECT_NE(whole.find("contacts"), std::string::npos);
  const Model read = read_model(folder / "model.vtkhdf");
  ASSERT_EQ(read.contacts.size(), 1u);
  const Contact &a = model.contacts[0], &b = read.contacts[0];
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.bone, b.bone);
  EXPECT_EQ(a.friction, b.friction);
  EXPECT_EQ(a.reach, b.reach);
  EXPECT_EQ(a.field.table, b.field.table);
  EXPECT_EQ(a.field.samples, b.field.samples);
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.area, b.area);
  EXPECT_EQ(a.centre, b.centre);
  EXPECT_FALSE(b.shape.triangles.empty());
  EXPECT_EQ(a.shape.vertices, b.shape.vertices);
  EXPECT_EQ(b.mass, 0.02);
  EXPECT_EQ(a.force, b.force);
  EXPECT_EQ(b.spring, 200);
  EXPECT_EQ(b.damping, 3);
  ASSERT_EQ(read.demo.at(0).bones.size(), 1u);
  EXPECT_EQ(read.demo[0].expression, -2);
  EXPECT_EQ(read.demo[0].bones[0].shift[0], 1e-3);
  EXPECT_EQ(a.binding.voxel, b.binding.voxel);
  EXPECT_EQ(a.binding.coordinates, b.binding.coordinates);
  EXPECT_EQ(bytes_of(read), whole);
  model.contacts.clear();
  EXPECT_EQ(bytes_of(model).find("contacts"), std::string::npos);
  EXPECT_TRUE(read_model(folder / "model.vtkhdf").contacts.empty());
  model = read;
  model.contacts[0].area.pop_back();
  EXPECT_THROW(check_model(model), Error);
}

}  // namespace
