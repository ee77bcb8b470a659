#include "frontalis/ros/conversions.hpp"
#include "frontalis/ros/shading.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace frontalis
{
namespace
{

TEST(Shading, ScaleEndsAtBothEndsAndShowsWhatIsNoNumberAsZero)
{
  EXPECT_EQ(false_colour(-3), false_colour(0));
  EXPECT_EQ(false_colour(3), false_colour(1));
  EXPECT_EQ(false_colour(std::numeric_limits<float>::quiet_NaN()), false_colour(0));
}

TEST(Shading, LightComesFromAboveAndHollowsAreDarker)
{
  // a sheet that faces +x, with a dent or a bump in its middle
  constexpr int edge = 9, middle = edge * edge / 2;
  TriangleMesh mesh;
  mesh.vertices.assign(edge * edge, { { 0, 0, 0 } });
  for (std::int32_t j = 0; j + 1 < edge; ++j)
    for (std::int32_t i = j * edge; i + 1 < (j + 1) * edge; ++i)
    {
      mesh.triangles.push_back({ { i, i + 1, i + edge } });
      mesh.triangles.push_back({ { i + 1, i + edge + 1, i + edge } });
    }
  const SkinShading shading(mesh, SkinColours(mesh.vertices.size(), { { 0.9F, 0.7F, 0.6F } }));
  const auto sheet = [](float height)
  {
    SkinState skin;
    skin.normals.assign(edge * edge, { { 1, 0, 0 } });
    for (int n = 0; n < edge * edge; ++n)
    {
      const float y = 2e-3F * static_cast<float>(n % edge - edge / 2);
      const float z = 2e-3F * static_cast<float>(n / edge - edge / 2);
      skin.vertices.push_back({ { height * std::exp(-(y * y + z * z) / 32e-6F), y, z } });
    }
    return skin;
  };
  std::vector<std::array<float, 3>> flat, hollow, raised;
  shading.colours(sheet(0), {}, flat);
  shading.colours(sheet(-2e-3F), {}, hollow);
  shading.colours(sheet(2e-3F), {}, raised);
  EXPECT_LT(hollow[middle][0], flat[middle][0]);
  EXPECT_GT(raised[middle][0], flat[middle][0]);

  std::vector<std::array<float, 3>> up, down;
  SkinState skin = sheet(0);
  skin.normals.assign(skin.vertices.size(), { { 0.6f, 0, 0.8f } });
  shading.colours(skin, {}, up);
  skin.normals.assign(skin.vertices.size(), { { 0.6f, 0, -0.8f } });
  shading.colours(skin, {}, down);
  EXPECT_GT(up[middle][1], down[middle][1]);
}

// What a flat skin reflects is the light that falls on it, times its albedo, plus the same highlight everywhere.
TEST(Shading, ColoursFollowTheGammaOfDisplays)
{
  constexpr float gamma = 2.2F;
  TriangleMesh mesh;
  mesh.vertices.resize(3);
  const SkinColours natural = { { { 0.1F, 0.1F, 0.1F } }, { { 0.35F, 0.35F, 0.35F } }, { { 0.7F, 0.7F, 0.7F } } };
  SkinState skin;
  skin.vertices.resize(3);
  skin.normals.assign(3, { { 1, 0, 0 } });
  SkinColours colours;
  SkinShading(mesh, natural).colours(skin, {}, colours);
  const auto ratio = [](const SkinColours& of)
  {
    const auto light = [&](std::size_t vertex) { return std::pow(of[vertex][0], gamma); };
    return (light(2) - light(0)) / (light(1) - light(0));
  };
  EXPECT_NEAR(ratio(colours), ratio(natural), 1e-2 * ratio(natural));
}

}  // namespace
}  // namespace frontalis
