// the film of a skin: edges that resolve its lines, on a smooth surface, and what it is refused for

#include "files.hpp"
#include "scene_pieces.hpp"

#include "bake/mesh/halve_edges.hpp"
#include "frontalis/model/model_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace frontalis
{
namespace
{

constexpr double radius = 12e-3;

// a ball whose film has lines 2 mm apart on one half of the skin
Scene ball_with_film()
{
  Scene scene = plain_scene(1.5e-3);
  scene.surfaces = { sphere_surface("skin", { 0, 0, 0 }, radius, 3e-3) };
  scene.volumes = { volume_inside("tissue", { "skin" }, "fat", true) };
  scene.skin.surface = "skin";
  scene.materials.push_back(material("film"));
  scene.materials.back().parameters["young"] = 100 * scene.materials.front().parameters["young"];
  scene.films = { SceneFilm{ "film", 0.1e-3, scene.materials.front().name, 0.02, Region() } };
  scene.films[0].crop.lower[2] = 0;
  return scene;
}

// Squares whose diagonals alternate stay such squares.
TEST(HalveEdges, keeps_a_regular_mesh_regular_and_closed)
{
  TriangleMesh mesh;
  constexpr std::int32_t n = 8;
  for (std::int32_t j = 0; j <= n; ++j)
    for (std::int32_t i = 0; i <= n; ++i)
      mesh.vertices.push_back({ { 1e-3 * i, 1e-3 * j, 0 } });
  for (std::int32_t j = 0; j < n; ++j)
    for (std::int32_t i = 0; i < n; ++i)
    {
      const std::int32_t a = j * (n + 1) + i, b = a + 1, c = b + n, d = c + 1;
      mesh.triangles.push_back({ { a, b, (i + j) % 2 == 0 ? c : d } });
      mesh.triangles.push_back({ { (i + j) % 2 == 0 ? b : a, d, c } });
    }
  // longer than the sides, shorter than the diagonals; twice as long on the right
  const auto longest = [](const Vector3d& p) { return p[0] < 4e-3 ? 1.2e-3 : 2.4e-3; };
  const auto parents = halve_edges(mesh, longest);
  ASSERT_EQ(mesh.vertices.size(), 81 + parents.size());
  for (std::size_t v = 0; v < parents.size(); ++v)
    EXPECT_LT(std::max(parents[v][0], parents[v][1]), 81 + static_cast<std::int32_t>(v));
  std::map<std::pair<std::int32_t, std::int32_t>, int> triangles_of;
  int small = 0;
  for (const Triangle& t : mesh.triangles)
  {
    double length[3];
    for (std::size_t c = 0; c < 3; ++c)
    {
      const auto ends = std::minmax(t[c], t[(c + 1) % 3]);
      ++triangles_of[ends];
      length[c] = (vertex(mesh, ends.second) - vertex(mesh, ends.first)).norm();
    }
    std::sort(length, length + 3);
    EXPECT_NEAR(length[2] / length[0], std::sqrt(2.0), 1e-9);
    EXPECT_NEAR(length[1], length[0], 1e-12);
    small += length[0] < 0.6e-3 ? 1 : 0;
  }
  EXPECT_GE(small, 4 * 8 * 8);
  for (const auto& [ends, count] : triangles_of)
  {
    const Vector3d middle = 0.5 * (vertex(mesh, ends.first) + vertex(mesh, ends.second));
    const bool rim = std::min({ middle[0], middle[1], 8e-3 - middle[0], 8e-3 - middle[1] }) < 1e-9;
    EXPECT_EQ(count, rim ? 1 : 2) << middle.transpose();
  }
}

TEST(BakeFilm, halves_edges_where_lines_are_wanted_and_keeps_the_surface_smooth)
{
  const Model model = bake(ball_with_film());
  const SkinFilm& film = model.film;
  EXPECT_NEAR(film.laws[0].modulus / film.laws[0].base_modulus, 100, 1e-6);
  EXPECT_EQ(film.laws[0].stretch, 0.02);
  const Model plain = bake(
      []
      {
        Scene scene = ball_with_film();
        scene.films.clear();
        return scene;
      }());
  EXPECT_EQ(film.carried, plain.skin.triangles);
  EXPECT_EQ(model.skin.vertices.size(), plain.skin.vertices.size() + film.parents.size());
  EXPECT_TRUE(plain.film.laws.empty());

  const auto place = [&](std::int32_t v) { return to_vector(model.to_scene(model.skin.vertices[v])); };
  double sum = 0, longest = 0, longest_below = 0, count = 0;
  for (const auto& t : model.skin.triangles)
    for (std::size_t c = 0; c < 3; ++c)
    {
      const Vector3d a = place(t[c]), b = place(t[(c + 1) % 3]);
      if (std::max(a[2], b[2]) < -5e-3)
        longest_below = std::max(longest_below, (b - a).norm());
      if (std::min(a[2], b[2]) < 1e-3)
        continue;
      sum += (b - a).norm();
      longest = std::max(longest, (b - a).norm());
      ++count;
    }
  EXPECT_LE(sum / count, film_wavelength(film.laws[0]) / 7.5);
  EXPECT_LE(longest, film_wavelength(film.laws[0]) / 4.5);
  EXPECT_GT(longest_below, film_wavelength(film.laws[0]) / 3);
  double off = 0;
  for (std::size_t v = 0; v < model.skin.vertices.size(); ++v)
    off = std::max(off, std::abs(place(static_cast<std::int32_t>(v)).norm() - radius));
  EXPECT_LT(off, 0.03e-3);
}

TEST(BakeFilm, of_a_later_entry_replaces_earlier_ones)
{
  Scene scene = ball_with_film();
  SceneFilm thin = scene.films[0];
  thin.thickness /= 2;
  thin.stretch = 0;
  thin.crop.lower[0] = 2e-3;
  scene.films.push_back(thin);
  const Model model = bake(scene);
  const SkinFilm& film = model.film;
  ASSERT_EQ(film.laws.size(), 2U);
  EXPECT_NEAR(film_wavelength(film.laws[1]), 0.5 * film_wavelength(film.laws[0]), 1e-12);
  EXPECT_EQ(film.laws[1].stretch, 0);
  ASSERT_EQ(film.law.size(), model.skin.vertices.size());
  const auto place = [&](std::int32_t v) { return to_vector(model.to_scene(model.skin.vertices[v])); };
  for (std::size_t v = 0; v < film.law.size(); ++v)
  {
    const Vector3d at = place(static_cast<std::int32_t>(v));
    if (std::abs(at[0] - 2e-3) < 1e-9 || std::abs(at[2]) < 1e-9)
      continue;
    EXPECT_EQ(film.law[v], at[2] < 0 ? -1 : at[0] < 2e-3 ? 0 : 1) << at.transpose();
  }
  double longest[2] = { 0, 0 };
  for (const auto& t : model.skin.triangles)
    for (std::size_t c = 0; c < 3; ++c)
      if (const std::int32_t law = film.law[t[c]]; law >= 0 && film.law[t[(c + 1) % 3]] == law)
        longest[law] = std::max(longest[law], (place(t[c]) - place(t[(c + 1) % 3])).norm());
  EXPECT_LE(longest[1], film_wavelength(film.laws[1]) / 4.5);
  EXPECT_LE(longest[0], film_wavelength(film.laws[0]) / 4.5);
  EXPECT_GT(longest[0], film_wavelength(film.laws[1]) / 4.5);
}

TEST(BakeFilm, is_the_same_in_the_model_file)
{
  Model model = bake(ball_with_film());
  model.film.crease.assign(model.skin.vertices.size(), 1e-5F);
  const TemporaryFolder folder;
  write_model(model, folder / "film.vtkhdf");
  const SkinFilm film = read_model(folder / "film.vtkhdf").film;
  EXPECT_EQ(film.laws[0].thickness, model.film.laws[0].thickness);
  EXPECT_EQ(film.laws[0].modulus, model.film.laws[0].modulus);
  EXPECT_EQ(film.laws[0].poisson, model.film.laws[0].poisson);
  EXPECT_EQ(film.laws[0].base_modulus, model.film.laws[0].base_modulus);
  EXPECT_EQ(film.laws[0].stretch, model.film.laws[0].stretch);
  EXPECT_EQ(film.law, model.film.law);
  EXPECT_EQ(film.carried, model.film.carried);
  EXPECT_EQ(film.parents, model.film.parents);
  EXPECT_EQ(film.crease, model.film.crease);
}

TEST(BakeFilm, must_be_stiff_and_have_lines_that_can_be_resolved_on_the_skin)
{
  Scene soft = ball_with_film();
  soft.films[0].material = soft.films[0].base;
  EXPECT_NE(fault_of(soft).find("at least 10 times as stiff"), std::string::npos) << fault_of(soft);
  Scene thin = ball_with_film();
  thin.films[0].thickness = 1e-6;
  EXPECT_NE(fault_of(thin).find("million vertices"), std::string::npos) << fault_of(thin);
  Scene beside = ball_with_film();
  beside.films[0].crop.lower[2] = 2 * radius;
  EXPECT_NE(fault_of(beside).find("skin: fine_lines: crop: no triangle"), std::string::npos) << fault_of(beside);
}

}  // namespace
}  // namespace frontalis
