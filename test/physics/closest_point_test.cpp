#include "frontalis/physics/closest_point.hpp"

#include <gtest/gtest.h>

#include <random>

using namespace frontalis::physics;

TEST(ClosestPoint, NotFartherThanAnyPointOfTheTriangle)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  const auto point = [&] { return Vec3<double>{ coordinate(random), coordinate(random), coordinate(random) }; };
  for (int trial = 0; trial < 300; ++trial)
  {
    const auto a = point(), b = point(), c = point(), p = 3.0 * point();
    const double found = norm(p - closest_point(p, a, b, c));
    double best = 1e9;
    constexpr int n = 60;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j)
        best = std::min(best, norm(p - (a + (double(i) / n) * (b - a) + (double(j) / n) * (c - a))));
    EXPECT_LE(found, best + 1e-12);
    EXPECT_GE(found, best - 0.1);
  }
}
