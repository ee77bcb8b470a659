#include "solver/contact/surface_tree.hpp"

#include "sphere_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace frontalis;

TEST(SurfaceTree, FindsWhatASearchOfAllTrianglesFinds)
{
  const TriangleMesh mesh = test::sphere(1, { { 0, 0, 0 } }, 6);
  const SurfaceTree tree(mesh);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> coordinate(-1.6, 1.6);
  for (int trial = 0; trial < 500; ++trial)
  {
    const SurfaceTree::Point p{ coordinate(random), coordinate(random), coordinate(random) };
    double best = 1e9;
    for (const auto& t : mesh.triangles)
    {
      const auto corner = [&](int c)
      {
        const auto& v = mesh.vertices[t[c]];
        return SurfaceTree::Point{ v[0], v[1], v[2] };
      };
      const auto d = p - physics::closest_point(p, corner(0), corner(1), corner(2));
      best = std::min(best, dot(d, d));
    }
    const auto found = tree.closest(p, 10);
    EXPECT_NEAR(found.squared_distance, best, 1e-12);
    // the pseudonormal tells inside from outside
    const bool outside = dot(p - found.point, found.normal) > 0;
    const double radius = norm(p);
    EXPECT_TRUE(outside == (radius > 1) || (radius >= 0.9 && radius <= 1)) << radius;
  }
  EXPECT_EQ(tree.closest({ 5, 0, 0 }, 1).triangle, -1);
}
