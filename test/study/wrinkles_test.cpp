// Measures furrows of skins whose depth and spacing are known.

#include "frontalis/study/wrinkles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

namespace frontalis
{
namespace
{

constexpr double pi = 3.14159265358979;

struct Sheet
{
  SkinState skin;
  SkinTriangles triangles;
};

// A cylinder of radius 75 mm about z, 80 mm wide and high, raised by `height` [m] of the arc length and z [m].
Sheet sheet(double edge, const std::function<double(double, double)>& height)
{
  constexpr double radius = 75e-3;
  const int n = static_cast<int>(std::lround(80e-3 / edge));
  Sheet out;
  const auto at = [&](double arc, double z) -> std::array<double, 3>
  {
    const double r = radius + height(arc, z);
    return { { r * std::cos(arc / radius), r * std::sin(arc / radius), z } };
  };
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
    {
      // Every other row is shifted by half an edge, so that no line of vertices follows a furrow.
      const double arc = (i + 0.5 * (j % 2)) * edge - 40e-3, z = j * edge, step = 1e-5;
      const auto p = at(arc, z), a = at(arc + step, z), b = at(arc, z + step);
      std::array<double, 3> normal{};
      for (std::size_t k = 0; k < 3; ++k)
      {
        const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
        normal[k] = ((a[l] - p[l]) * (b[m] - p[m]) - (a[m] - p[m]) * (b[l] - p[l])) / (step * step);
      }
      const double length = std::hypot(normal[0], normal[1], normal[2]);
      const auto single = [](double x) { return static_cast<float>(x); };
      out.skin.vertices.push_back({ { single(p[0]), single(p[1]), single(p[2]) } });
      out.skin.normals.push_back(
          { { single(normal[0] / length), single(normal[1] / length), single(normal[2] / length) } });
      if (i < n && j < n)
      {
        const int v = j * (n + 1) + i, w = v + n + 1;
        out.triangles.push_back({ { v, v + 1, w } });
        out.triangles.push_back({ { v + 1, w + 1, w } });
      }
    }
  return out;
}

struct Case
{
  double spacing, depth, angle;  // [m, m, rad from horizontal]
};

class Waves : public testing::TestWithParam<Case>
{
};

TEST_P(Waves, have_their_depth_spacing_and_direction)
{
  const auto [spacing, depth, angle] = GetParam();
  const double c = std::cos(angle), s = std::sin(angle), length = spacing;
  const auto wave = [&, d = depth](double arc, double z)
  { return 0.5 * d * std::cos(2 * pi * (c * (z - 40e-3) - s * arc) / length); };
  const Sheet rest = sheet(1e-3, [](double, double) { return 0; }), now = sheet(1e-3, wave);
  WrinkleSettings settings;
  settings.lower = { -1, -25e-3, 18e-3 };
  settings.upper = { 1, 25e-3, 62e-3 };
  const Wrinkles found = WrinkleMeter(rest.skin, now.triangles, settings).measure(now.skin);
  EXPECT_NEAR(found.spacing, spacing, 0.03 * spacing);
  EXPECT_NEAR(found.depth, depth, 0.05 * depth);
  EXPECT_NEAR(std::abs(found.direction[1] * c + found.direction[2] * s), 1, 1e-3);
  if (angle == 0)
  {
    // The middle of the box is on a ridge.
    EXPECT_EQ(found.furrows.size(), 2 * static_cast<std::size_t>(std::lround(22e-3 / spacing)));
  }
}

INSTANTIATE_TEST_SUITE_P(Skins, Waves,
                         testing::Values(Case{ 6e-3, 0.4e-3, 0 }, Case{ 10e-3, 1.5e-3, 0 }, Case{ 16e-3, 2.5e-3, 0 },
                                         Case{ 10e-3, 1e-3, 0.6 }, Case{ 9e-3, 1e-3, pi / 2 }));

TEST(Wrinkles, count_one_furrow_and_its_length)
{
  // A furrow of 2 mm, 40 mm long.
  const auto furrow = [](double arc, double z)
  {
    const double along = 1 / (1 + std::exp((std::abs(arc) - 20e-3) / 1e-3));
    return -2e-3 * along * std::exp(-std::pow((z - 40e-3) / 2e-3, 2));
  };
  const Sheet rest = sheet(1e-3, [](double, double) { return 0; }), now = sheet(1e-3, furrow);
  const Wrinkles found = WrinkleMeter(rest.skin, now.triangles).measure(now.skin);
  ASSERT_EQ(found.furrows.size(), 1u);
  EXPECT_NEAR(found.furrows[0].length, 40e-3, 4e-3);
  EXPECT_NEAR(found.furrows[0].middle[2], 40e-3, 0.5e-3);
  EXPECT_NEAR(found.deepest, 2e-3, 0.1e-3);
  EXPECT_EQ(found.spacing, 0);
  EXPECT_NEAR(found.count, 1, 1e-9);
}

// A second sheet of the same size 4 mm behind, which faces the other way, as the lining of lips does.
Sheet lined(Sheet sheet, const Sheet& lining)
{
  const auto first = static_cast<std::int32_t>(sheet.skin.vertices.size());
  for (std::size_t v = 0; v < lining.skin.vertices.size(); ++v)
  {
    auto p = lining.skin.vertices[v], n = lining.skin.normals[v];
    p[0] -= 4e-3F;
    for (float& component : n)
      component = -component;
    sheet.skin.vertices.push_back(p);
    sheet.skin.normals.push_back(n);
  }
  for (const auto& t : lining.triangles)
    sheet.triangles.push_back({ { first + t[0], first + t[2], first + t[1] } });
  return sheet;
}

TEST(Wrinkles, are_those_of_the_outer_skin)
{
  const auto wave = [](double, double z) { return 0.5e-3 * std::cos(2 * pi * z / 12e-3); };
  const Sheet flat = sheet(0.8e-3, [](double, double) { return 0; }), waved = sheet(0.8e-3, wave);
  WrinkleSettings part;
  part.lower = { { -1, -30e-3, 10e-3 } };
  part.upper = { { 1, 30e-3, 70e-3 } };
  const Wrinkles alone = WrinkleMeter(flat.skin, flat.triangles, part).measure(waved.skin);
  EXPECT_GT(alone.furrows.size(), 2u);
  const Sheet rest = lined(flat, flat), now = lined(waved, flat);
  const Wrinkles found = WrinkleMeter(rest.skin, rest.triangles, part).measure(now.skin);
  EXPECT_EQ(found.furrows.size(), alone.furrows.size());
  EXPECT_NEAR(found.deepest, alone.deepest, 0.1 * alone.deepest);
  EXPECT_NEAR(found.spacing, alone.spacing, 0.1 * alone.spacing);
}

TEST(Wrinkles, leave_out_what_is_there_at_rest)
{
  const auto wave = [](double, double z) { return 1e-3 * std::cos(2 * pi * z / 10e-3); };
  const Sheet skin = sheet(1.5e-3, wave);
  const Wrinkles found = WrinkleMeter(skin.skin, skin.triangles).measure(skin.skin);
  EXPECT_TRUE(found.furrows.empty());
  EXPECT_EQ(found.count, 0);
  EXPECT_EQ(found.depth, 0);
}

TEST(Wrinkles, are_measured_until_progress_throws)
{
  const Sheet flat = sheet(2e-3, [](double, double) { return 0; });
  std::vector<double> done;
  const auto note = [&](double now) { done.push_back(now); };
  const WrinkleMeter meter(flat.skin, flat.triangles, {}, note);
  EXPECT_GE(done.size(), flat.skin.vertices.size() / 500);
  done.clear();
  meter.measure(flat.skin, note);
  EXPECT_GE(done.size(), flat.skin.vertices.size() / 500);
  EXPECT_TRUE(std::is_sorted(done.begin(), done.end()));
  EXPECT_GE(done.front(), 0);
  EXPECT_LE(done.back(), 1);
  std::size_t calls = 0;
  const auto stop = [&](double)
  {
    if (++calls == 3)
      throw std::runtime_error("stop");
  };
  EXPECT_THROW(meter.measure(flat.skin, stop), std::runtime_error);
  EXPECT_EQ(calls, 3u);
}

// The heights of a wave do not depend on the fineness of the mesh.
TEST(Wrinkles, have_the_same_height_on_a_finer_mesh)
{
  const auto wave = [](double, double z) { return 0.5e-3 * std::cos(2 * pi * (z - 40e-3) / 10e-3); };
  std::array<double, 2> height{};
  for (const double edge : { 0.5e-3, 2e-3 })
  {
    const Sheet skin = sheet(edge, wave);
    const std::size_t row = static_cast<std::size_t>(std::lround(40e-3 / edge)),
                      n = static_cast<std::size_t>(std::lround(80e-3 / edge)) + 1;
    height[edge < 1e-3 ? 0 : 1] = fold_heights(skin.skin, skin.triangles, 10e-3)[row * n + n / 2];
  }
  EXPECT_NEAR(height[0], 0.5e-3, 0.02e-3);
  EXPECT_NEAR(height[1], height[0], 0.01e-3);
}

}  // namespace
}  // namespace frontalis
