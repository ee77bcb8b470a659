#include "../../src/solver/surface_tree.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace frontalis;

namespace
{

// an octahedron divided into a sphere-like mesh of radius 1
TriangleMesh ball(int divisions)
{
  TriangleMesh mesh;
  const auto add = [&](double x, double y, double z)
  {
    const double length = std::sqrt(x * x + y * y + z * z);
    mesh.vertices.push_back({ { x / length, y / length, z / length } });
    return static_cast<std::int32_t>(mesh.vertices.size()) - 1;
  };
  for (int octant = 0; octant < 8; ++octant)
  {
    const double sx = octant & 1 ? -1 : 1, sy = octant & 2 ? -1 : 1, sz = octant & 4 ? -1 : 1;
    const bool flip = sx * sy * sz < 0;
    for (int i = 0; i < divisions; ++i)
      for (int j = 0; i + j < divisions; ++j)
        for (int half = 0; half < (i + j + 1 < divisions ? 2 : 1); ++half)
        {
          const auto at = [&](int a, int b) { return add(sx * (divisions - a - b), sy * a, sz * b); };
          std::array<std::int32_t, 3> t =
              half == 0 ? std::array<std::int32_t, 3>{ { at(i, j), at(i + 1, j), at(i, j + 1) } }
                        : std::array<std::int32_t, 3>{ { at(i + 1, j), at(i + 1, j + 1), at(i, j + 1) } };
          if (flip)
            std::swap(t[1], t[2]);
          mesh.triangles.push_back(t);
        }
  }
  return mesh;
}

}  // namespace

TEST(SurfaceTree, FindsWhatASearchOfAllTrianglesFinds)
{
  const TriangleMesh mesh = ball(6);
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
