#include "solver/contact/triangle_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

namespace frontalis
{
namespace
{

using Vector = TriangleGrid::Vector;

// Triangles of very unequal sizes, and points among and far from them.
TEST(TriangleGrid, visits_all_triangles_within_reach_and_no_others)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-0.01, 0.01), size(0.0001, 0.003);
  std::vector<TriangleGrid::Triangle> triangles;
  for (int t = 0; t < 500; ++t)
    triangles.push_back({ { place(random), place(random), place(random) }, size(random) });
  TriangleGrid grid;
  grid.resize(triangles.size());
  constexpr double reach = 0.001, rounding = 1e-7;
  grid.build(reach, triangles);
  EXPECT_NEAR(grid.edge(), 0.004, 1e-4);
  std::size_t found = 0;
  for (int p = 0; p < 300; ++p)
  {
    const double far = p % 3 == 0 ? 2 : 1;
    const Vector at{ far * place(random), far * place(random), far * place(random) };
    std::set<std::int32_t> visited;
    grid.near(at, [&](std::int32_t t) { visited.insert(t); });
    for (std::size_t t = 0; t < triangles.size(); ++t)
    {
      const double outside = norm(triangles[t].centre - at) - triangles[t].radius - reach;
      const std::size_t times = visited.count(static_cast<std::int32_t>(t));
      if (std::abs(outside) > rounding)
      {
        EXPECT_EQ(times, outside < 0 ? 1U : 0U) << "triangle " << t << " and point " << p;
      }
    }
    found += visited.size();
  }
  EXPECT_GT(found, 300U);
}

TEST(TriangleGrid, visits_nothing_near_a_place_that_is_not_finite)
{
  TriangleGrid grid;
  grid.resize(1);
  grid.build(1, { { { 0, 0, 0 }, 1 } });
  bool any = false;
  grid.near({ std::nan(""), 0, 0 }, [&](std::int32_t) { any = true; });
  EXPECT_FALSE(any);
}

}  // namespace
}  // namespace frontalis
