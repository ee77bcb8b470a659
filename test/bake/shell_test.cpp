// layers that are shells: their triangles, depth and material, and the material that stays in the voxels

#include "files.hpp"
#include "scene_pieces.hpp"

#include "frontalis/model/effects.hpp"
#include "frontalis/model/model_file.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace frontalis
{
namespace
{

constexpr double radius = 12e-3, voxel = 1.5e-3, corneum = 0.02e-3, dermis = 1e-3;

// a ball with two layers, of which the outer, the inner or both are shells
Scene ball_in_shells(bool outer, bool inner)
{
  Scene scene = plain_scene(voxel);
  scene.surfaces = { sphere_surface("skin", { 0, 0, 0 }, radius, 0.7e-3) };
  scene.volumes = { volume_inside("tissue", { "skin" }, "fat", true) };
  scene.materials.push_back(material("corneum"));
  scene.layers = { { "corneum", "skin", "tissue", "corneum", corneum, 1, outer },
                   { "dermis", "skin", "tissue", "dermis", dermis, 2, inner } };
  return scene;
}

double distance(const Vector3& a, const Vector3& b)
{
  return std::sqrt(std::pow(a[0] - b[0], 2) + std::pow(a[1] - b[1], 2) + std::pow(a[2] - b[2], 2));
}

TEST(BakeShell, covers_the_surface_at_the_depth_of_the_layer_with_edges_of_a_voxel)
{
  const double depths[] = { 0.5 * corneum, corneum + 0.5 * dermis };
  for (std::size_t s = 0; s < 2; ++s)
  {
    const Model model = bake(ball_in_shells(s == 0, s == 1));
    ASSERT_EQ(model.shells.size(), 1U);
    EXPECT_TRUE(effects_of(model).has(Effect::shell));
    const Shell& shell = model.shells[0];
    EXPECT_EQ(model.materials[shell.material].name, s == 0 ? "corneum" : "dermis");
    EXPECT_EQ(shell.thickness, s == 0 ? corneum : dermis);
    double area = 0, shortest = 1, sum = 0, farthest = 0;
    for (const auto& t : shell.surface.triangles)
    {
      const auto& v = shell.surface.vertices;
      const double a = distance(v[t[0]], v[t[1]]), b = distance(v[t[1]], v[t[2]]), c = distance(v[t[2]], v[t[0]]);
      const double half = 0.5 * (a + b + c);
      area += std::sqrt(half * (half - a) * (half - b) * (half - c));
      shortest = std::min({ shortest, a, b, c });
      sum += (a + b + c) / 3;
    }
    for (const Vector3& v : shell.surface.vertices)
      farthest = std::max(farthest, std::abs(distance(transformed(model.to_scene, v), {}) - (radius - depths[s])));
    EXPECT_NEAR(area / (4 * pi * std::pow(radius - depths[s], 2)), 1, 0.03);
    EXPECT_NEAR(sum / static_cast<double>(shell.surface.triangles.size()) / (1.2 * voxel), 1, 0.1);
    EXPECT_GT(shortest, 0.6 * voxel);
    EXPECT_LT(farthest, 0.05e-3);
  }
}

// A slit through the ball: no triangle holds its sides together.
TEST(BakeShell, ends_at_slits)
{
  constexpr double cut = 0.2e-3;
  Scene scene = ball_in_shells(false, true);
  scene.surfaces.push_back(box_surface("cut", { cut + 20e-3, 0, 0 }, { 40e-3, 60e-3, 60e-3 }));
  scene.volumes[0].slits = { "cut" };
  // a half that nothing holds would be left out of the model
  for (const double side : { -1.0, 1.0 })
  {
    SceneConstraint hold;
    hold.name = side < 0 ? "left" : "right";
    hold.surfaces = { hold.name };
    scene.surfaces.push_back(sphere_surface(hold.name, { side * 6e-3, 0, 0 }, 2e-3));
    scene.constraints.push_back(hold);
  }
  const Model model = bake(scene);
  ASSERT_EQ(model.shells.size(), 1U);
  std::array<std::size_t, 2> on_side{};
  for (const auto& t : model.shells[0].surface.triangles)
  {
    std::size_t beyond = 0;
    for (const std::int32_t v : t)
      beyond += transformed(model.to_scene, model.shells[0].surface.vertices[v])[0] > cut ? 1 : 0;
    ASSERT_TRUE(beyond == 0 || beyond == 3);
    ++on_side[beyond / 3];
  }
  EXPECT_GT(std::min(on_side[0], on_side[1]), 300u);
}

// Corneum and dermis, as published, become a plate of 1.25 mm and 0.883 MPa, whose middle is near the stiff corneum.
TEST(BakeShell, layers_on_each_other_become_one_plate)
{
  Scene scene = ball_in_shells(true, true);
  scene.materials.push_back(material("stiff", 48e6));
  scene.materials.push_back(material("soft", 81.4e3));
  scene.layers[0].material = "stiff";
  scene.layers[1].material = "soft";
  scene.layers[1].thickness = 1.8e-3;
  const Model model = bake(scene);
  ASSERT_EQ(model.shells.size(), 1U);
  const Shell& plate = model.shells[0];
  EXPECT_EQ(plate.name, "corneum + dermis");
  EXPECT_NEAR(plate.thickness, 1.25e-3, 0.005e-3);
  const auto& numbers = model.materials[plate.material].parameters;
  EXPECT_NEAR(9 * numbers[0] * numbers[1] / (3 * numbers[1] + numbers[0]), 0.883e6, 0.005e6);
  const double stretching[] = { 48e6 * corneum, 81.4e3 * 1.8e-3 };
  const double neutral =
      (stretching[0] * 0.5 * corneum + stretching[1] * (corneum + 0.9e-3)) / (stretching[0] + stretching[1]);
  for (const Vector3& v : plate.surface.vertices)
    EXPECT_NEAR(distance(transformed(model.to_scene, v), {}), radius - neutral, 0.05e-3);
}

TEST(BakeShell, shells_with_a_layer_between_them_stay_apart)
{
  Scene scene = ball_in_shells(true, false);
  scene.layers.push_back({ "fascia", "skin", "tissue", "corneum", corneum, 3, true });
  const Model model = bake(scene);
  ASSERT_EQ(model.shells.size(), 2U);
  EXPECT_EQ(model.shells[0].name, "corneum");
  EXPECT_EQ(model.shells[1].name, "fascia");
}

TEST(BakeShell, nothing_of_it_is_in_the_voxels)
{
  const Model model = bake(ball_in_shells(true, true));
  for (std::size_t m = 0; m < model.mixture_material.size(); ++m)
    EXPECT_TRUE(model.materials[model.mixture_material[m]].name == "fat" || model.mixture_proportion[m] == 0);
  EXPECT_TRUE(bake(ball_in_shells(false, false)).shells.empty());
}

TEST(BakeShell, is_the_same_in_the_model_file)
{
  Scene scene = ball_in_shells(true, false);
  scene.layers.push_back({ "fascia", "skin", "tissue", "corneum", corneum, 3, true });
  const Model model = bake(scene);
  const TemporaryFolder folder;
  write_model(model, folder / "shells.vtkhdf");
  const Model read = read_model(folder / "shells.vtkhdf");
  ASSERT_EQ(read.shells.size(), 2U);
  for (std::size_t s = 0; s < 2; ++s)
  {
    EXPECT_EQ(read.shells[s].name, model.shells[s].name);
    EXPECT_EQ(read.shells[s].thickness, model.shells[s].thickness);
    EXPECT_EQ(read.shells[s].material, model.shells[s].material);
    EXPECT_EQ(read.shells[s].surface.vertices, model.shells[s].surface.vertices);
    EXPECT_EQ(read.shells[s].surface.triangles, model.shells[s].surface.triangles);
    EXPECT_EQ(read.shells[s].binding.voxel, model.shells[s].binding.voxel);
    EXPECT_EQ(read.shells[s].binding.coordinates, model.shells[s].binding.coordinates);
  }
}

TEST(BakeShell, is_refused_where_the_surface_is_far_from_the_tissue)
{
  Scene scene = ball_in_shells(true, true);
  scene.surfaces.push_back(sphere_surface("shield", { 0, 0, 0 }, 2 * radius, 2e-3));
  scene.layers = { { "film", "shield", "tissue", "corneum", corneum, 7, true } };
  try
  {
    bake(scene);
    FAIL() << "no error";
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find(":7: layer 'film': no triangle of surface 'shield'"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace frontalis
