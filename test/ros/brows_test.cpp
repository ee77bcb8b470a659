#include "frontalis/ros/shading.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace frontalis
{
namespace
{

/// A flat skin with points every 2 mm: x = 0, y from -60 to 60 mm, z from 0 to 40 mm; local frame = face frame.
Model flat_face()
{
  Model model;
  for (int row = 0; row <= 20; ++row)
    for (int column = -30; column <= 30; ++column)
      model.skin.vertices.push_back({ { 0, 2e-3 * column, 2e-3 * row } });
  return model;
}

TEST(Brows, CoverABandThroughTheLandmarksOfASide)
{
  Model model = flat_face();
  model.landmarks = { "brow_left", "chin", "brow_mid_left" };
  model.landmark_positions = { { { 0, 0.042, 0.02 } }, { { 0, 0, 0 } }, { { 0, 0.024, 0.02 } } };
  const auto cover = brow_cover(model);
  ASSERT_EQ(cover.size(), model.skin.vertices.size());
  for (std::size_t vertex = 0; vertex < cover.size(); ++vertex)
  {
    const double y = model.skin.vertices[vertex][1], off = std::abs(model.skin.vertices[vertex][2] - 0.02);
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
  Model model = flat_face();
  model.landmarks = { "brow_left", "brow_right" };
  model.landmark_positions = { { { 0, 0.03, 0.02 } }, { { 0, -0.03, 0.02 } } };
  for (const float share : brow_cover(model))
    EXPECT_EQ(share, 0);
}

}  // namespace
}  // namespace frontalis
