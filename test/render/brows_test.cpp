#include "frontalis/render/face_appearance.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace frontalis
{
namespace
{

using Points = std::vector<std::array<float, 3>>;

/// A flat skin with points every 2 mm: x = 0, y from -60 to 60 mm, z from 0 to 40 mm.
Points flat_face()
{
  Points vertices;
  for (int row = 0; row <= 20; ++row)
    for (int column = -30; column <= 30; ++column)
      vertices.push_back({ { 0, 2e-3F * static_cast<float>(column), 2e-3F * static_cast<float>(row) } });
  return vertices;
}

TEST(Brows, CoverABandThroughTheLandmarksOfASide)
{
  const Points skin = flat_face();
  const auto cover = brow_cover({ "brow_left", "chin", "brow_mid_left" },
                                { { { 0, 0.042F, 0.02F } }, { { 0, 0, 0 } }, { { 0, 0.024F, 0.02F } } }, skin);
  ASSERT_EQ(cover.size(), skin.size());
  for (std::size_t vertex = 0; vertex < cover.size(); ++vertex)
  {
    const double y = skin[vertex][1], off = std::abs(skin[vertex][2] - 0.02);
    EXPECT_GE(cover[vertex], 0);
    EXPECT_LT(cover[vertex], 1);
    if (y < 0.005 || off > 0.0065)
    {
      EXPECT_EQ(cover[vertex], 0);
    }
    if (y > 0.0235 && y < 0.0425 && off < 1e-6)
    {
      EXPECT_GT(cover[vertex], 0.5);
    }
  }
}

TEST(Brows, NeedTwoLandmarksOnASide)
{
  for (const float share :
       brow_cover({ "brow_left", "brow_right" }, { { { 0, 0.03F, 0.02F } }, { { 0, -0.03F, 0.02F } } }, flat_face()))
    EXPECT_EQ(share, 0);
}

}  // namespace
}  // namespace frontalis
