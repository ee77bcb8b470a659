// The bake of surfaces of the tissue that touch each other.

#include "frontalis/error.hpp"
#include "frontalis/model/effects.hpp"
#include "frontalis/model/model_file.hpp"
#include "frontalis/physics/number.hpp"

#include "bake/scene_pieces.hpp"
#include "files.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace
{

using namespace frontalis;

/// Two blocks of 8 x 6 x 4 mm, one above the other at a distance of 1 mm, held at their far sides.
Scene two_blocks()
{
  Scene scene = plain_scene(1e-3);
  scene.surfaces = { box_surface("lower", { 4e-3, 3e-3, 2e-3 }, { 8e-3, 6e-3, 4e-3 }),
                     box_surface("upper", { 4e-3, 3e-3, 7e-3 }, { 8e-3, 6e-3, 4e-3 }),
                     box_surface("floor", { 4e-3, 3e-3, -1e-3 }, { 10e-3, 8e-3, 2e-3 }),
                     box_surface("roof", { 4e-3, 3e-3, 10e-3 }, { 10e-3, 8e-3, 2e-3 }) };
  scene.volumes = { volume_inside("below", { "lower" }, "fat", true),
                    volume_inside("above", { "upper" }, "fat", true) };
  SceneConstraint hold;
  hold.name = "hold";
  hold.surfaces = { "floor", "roof" };
  SceneConstraint touch;
  touch.name = "touch";
  touch.kind = SceneConstraint::Kind::self_contact;
  touch.surfaces = { "lower", "upper" };
  touch.friction = 0.3;
  touch.crop.lower[2] = 3e-3;
  touch.crop.upper[2] = 6e-3;
  touch.line = 9;
  scene.constraints = { hold, touch };
  return scene;
}

TEST(BakedSelfContact, surfaces_may_extend_far_beyond_the_tissue)
{
  Scene scene = two_blocks();
  scene.surfaces[0].shape->centre[0] += 40e-3;
  scene.surfaces[0].shape->size[0] += 80e-3;
  scene.volumes[0].crop.upper[0] = 8e-3;
  EXPECT_EQ(bake(scene).self_contacts.size(), 1u);
}

TEST(BakedSelfContact, surfaces_face_away_from_the_tissue)
{
  const Model model = bake(two_blocks());
  ASSERT_EQ(model.self_contacts.size(), 1u);
  const SelfContact& contact = model.self_contacts[0];
  EXPECT_EQ(contact.name, "touch");
  EXPECT_EQ(contact.friction, 0.3);
  EXPECT_TRUE(effects_of(model).has(Effect::self_contact));
  EXPECT_FALSE(effects_of(model).has(Effect::contact));
  // the surface has the two sides that face each other, and strips of 1 mm around them
  const std::vector<double> areas = vertex_areas(contact.surface);
  EXPECT_NEAR(std::accumulate(areas.begin(), areas.end(), 0.0), 2 * (48e-6 + 28e-6), 1e-9);
  EXPECT_GT(contact.surface.vertices.size(), 2 * 9u * 7u);
  // each triangle's normal points from the centre of the voxel of its corner to the triangle
  for (const auto& triangle : contact.surface.triangles)
  {
    const auto corner = [&](std::size_t i)
    {
      const auto& p = contact.surface.vertices[triangle[i]];
      return physics::Vec3<double>{ p[0], p[1], p[2] };
    };
    const auto& voxel = model.voxels[contact.binding.voxel[triangle[0]]];
    const physics::Vec3<double> centre{ (voxel[0] + 0.5) * 1e-3, (voxel[1] + 0.5) * 1e-3, (voxel[2] + 0.5) * 1e-3 };
    const auto normal = cross(corner(1) - corner(0), corner(2) - corner(0));
    EXPECT_GT(dot(normal, corner(0) - centre), 0);
  }
}

TEST(BakedSelfContact, what_cannot_be_is_refused)
{
  Scene scene = two_blocks();
  scene.constraints[1].crop.upper[2] = 4.5e-3;
  EXPECT_EQ(fault_of(scene).find("test.yaml:9: constraint 'touch': no triangle of surface 'upper' lies in its crop"),
            0u)
      << fault_of(scene);
  // a box whose upper and lower sides are in the middle of the tissue
  scene = two_blocks();
  scene.surfaces.push_back(box_surface("inner", { 4e-3, 3e-3, 2e-3 }, { 4e-3, 3e-3, 1e-3 }));
  scene.constraints[1].surfaces = { "inner" };
  scene.constraints[1].crop.lower[2] = 0;
  EXPECT_EQ(fault_of(scene).find("test.yaml:9: constraint 'touch': surface 'inner' has as much tissue in front"), 0u)
      << fault_of(scene);
}

TEST(BakedSelfContact, a_file_gives_it_back)
{
  const TemporaryFolder folder;
  Model model = bake(two_blocks());
  write_model(model, folder / "model.vtkhdf");
  const Model read = read_model(folder / "model.vtkhdf");
  ASSERT_EQ(read.self_contacts.size(), 1u);
  const SelfContact &a = model.self_contacts[0], &b = read.self_contacts[0];
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.friction, b.friction);
  EXPECT_EQ(a.surface.vertices, b.surface.vertices);
  EXPECT_EQ(a.surface.triangles, b.surface.triangles);
  EXPECT_EQ(a.binding.voxel, b.binding.voxel);
  EXPECT_EQ(a.binding.coordinates, b.binding.coordinates);
  model.self_contacts.clear();
  write_model(model, folder / "model.vtkhdf");
  EXPECT_TRUE(read_model(folder / "model.vtkhdf").self_contacts.empty());
  model = read;
  model.self_contacts[0].binding.voxel.pop_back();
  EXPECT_THROW(check_model(model), Error);
}

}  // namespace
