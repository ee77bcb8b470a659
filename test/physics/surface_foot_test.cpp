// The foot of a point on the smooth surface that triangles approximate, and forces between point and triangle.

#include "frontalis/physics/surface_foot.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace frontalis
{
namespace physics
{
namespace
{

using Vector = Vec3<double>;

struct Mesh
{
  std::vector<Vector> place, normal;
  std::vector<std::array<int, 3>> triangles;

  SurfaceTriangle<double> triangle(std::size_t t) const
  {
    SurfaceTriangle<double> out;
    for (std::size_t i = 0; i < 3; ++i)
    {
      out.corner[i] = place[triangles[t][i]];
      out.normal[i] = normal[triangles[t][i]];
    }
    return out;
  }
  // Finds the triangle that contains the foot, and returns the foot.
  SurfaceFoot<double> foot(const Vector& x) const
  {
    for (std::size_t t = 0; t < triangles.size(); ++t)
    {
      const auto found = surface_foot(triangle(t), x);
      if (found.weight[0] > -1e-7 && found.weight[1] > -1e-7 && found.weight[2] > -1e-7 && found.height > -0.5)
        return found;
    }
    ADD_FAILURE() << "no foot";
    return {};
  }
};

// Part of a sphere around the origin, with irregular triangles whose mean edge is about 1.
Mesh sphere(double radius)
{
  Mesh mesh;
  const int count = 13;
  for (int j = 0; j < count; ++j)
    for (int i = 0; i < count; ++i)
    {
      const double x = i - 6 + 0.2 * std::sin(7.0 * i + 3.0 * j), y = j - 6 + 0.2 * std::cos(5.0 * i - 2.0 * j);
      const Vector way{ x, y, radius };
      mesh.normal.push_back((1 / norm(way)) * way);
      mesh.place.push_back(radius * mesh.normal.back());
    }
  for (int j = 0; j + 1 < count; ++j)
    for (int i = 0; i + 1 < count; ++i)
    {
      const int a = j * count + i, b = a + 1, c = a + count, d = c + 1;
      mesh.triangles.push_back({ { a, b, d } });
      mesh.triangles.push_back({ { a, d, c } });
    }
  return mesh;
}

// A point slides 1.4 % of an edge below a sphere whose triangles meet at about 7 degrees. Its depth is measured from
// the smooth sphere instead of the triangles, and force and depth do not jump from one triangle to the next.
TEST(SurfaceFoot, SlidingOverTrianglesIsSmooth)
{
  const double radius = 8, depth = 0.014, step = 1e-4;
  const Mesh mesh = sphere(radius);
  double deepest_error = 0, normal_error = 0, gap_jump = 0, normal_jump = 0, facet_error = 0;
  SurfaceFoot<double> before{};
  for (int i = 0; i < 60000; ++i)
  {
    const double angle = (i * step - 3) / radius;
    const Vector outwards{ std::cos(0.3) * std::sin(angle), std::sin(0.3) * std::sin(angle), std::cos(angle) };
    const auto foot = mesh.foot((radius - depth) * outwards);
    deepest_error = std::max(deepest_error, std::abs(foot.gap + depth));
    facet_error = std::max(facet_error, std::abs(foot.height + depth));
    normal_error = std::max(normal_error, norm(foot.normal - outwards));
    if (i > 0)
    {
      gap_jump = std::max(gap_jump, std::abs(foot.gap - before.gap));
      normal_jump = std::max(normal_jump, norm(foot.normal - before.normal));
    }
    before = foot;
  }
  EXPECT_LT(deepest_error, 0.05 * depth);
  EXPECT_GT(facet_error, 1 * depth);
  EXPECT_LT(normal_error, 0.02);
  EXPECT_LT(gap_jump, 1e-3 * depth);
  EXPECT_LT(normal_jump, 1.5 * step / radius);
}

TEST(SurfaceFoot, ForcesAreOppositeInSumAndInMoment)
{
  const Mesh mesh = sphere(3);
  for (int i = 0; i < 40; ++i)
  {
    const auto triangle = mesh.triangle(100 + i);
    const Vector x = (1.0 / 3) * (triangle.corner[0] + triangle.corner[1] + triangle.corner[2]) +
                     Vector{ 0.3 * std::sin(i), 0.2 * std::cos(3 * i), 0.2 * std::sin(5 * i) };
    const auto foot = surface_foot(triangle, x);
    const Vector across = cross(foot.gradient, { 0.3, 0.8, 0.1 });
    const double pressed = 2.5;
    const Vector force = pressed * foot.gradient + across;
    Vector sum = force, moment = cross(x, force);
    for (int c = 0; c < 3; ++c)
    {
      const Vector part = corner_force(triangle, foot, c, pressed) + corner_drag(foot, c, across);
      sum = sum + part;
      moment =
          moment + cross(triangle.corner[c], part) + cross(triangle.normal[c], corner_turn(triangle, foot, c, pressed));
    }
    EXPECT_LT(norm(sum), 1e-13);
    EXPECT_LT(norm(moment), 1e-12);
  }
}

// A point that a triangle carries follows a rotation, and the forces on the corners are the adjoint of this map.
TEST(SurfaceFoot, ATriangleCarriesAPointAlong)
{
  const Mesh mesh = sphere(3);
  const auto triangle = mesh.triangle(77);
  const Vector x = triangle.corner[0] + Vector{ 0.2, 0.1, -0.3 }, turn{ 0.3, -0.2, 0.5 }, along{ 0.7, 0.1, -0.4 };
  const auto foot = surface_foot(triangle, x);
  Vector way{ 0, 0, 0 };
  double work = 0;
  for (int c = 0; c < 3; ++c)
  {
    const Vector moved = cross(turn, triangle.corner[c]);
    way = way + carried(foot, c, moved);
    work += dot(corner_drag(foot, c, along), moved);
  }
  EXPECT_LT(norm(way - cross(turn, x)), 1e-13);
  EXPECT_NEAR(work, -dot(along, way), 1e-13);
}

// Forces are the gradient of the energy, by finite differences.
TEST(SurfaceFoot, ForcesAreTheGradientOfTheEnergy)
{
  const Mesh mesh = sphere(8);
  for (int t = 60; t < 70; ++t)
  {
    auto triangle = mesh.triangle(t);
    Vector x = 0.3 * triangle.corner[0] + 0.25 * triangle.corner[1] + 0.45 * triangle.corner[2];
    x = (1 - 0.014 / 8) * (8 / norm(x)) * x;
    const auto foot = surface_foot(triangle, x);
    const double step = 1e-6;
    for (int c = 0; c < 3; ++c)
    {
      const Vector force = corner_force(triangle, foot, c, 1.0), turn = corner_turn(triangle, foot, c, 1.0);
      for (const Vector& way : { Vector{ 1, 0, 0 }, Vector{ 0, 1, 0 }, Vector{ 0, 0, 1 } })
      {
        const auto change = [&](Vector& what, const Vector& by)
        {
          const Vector before = what;
          what = before + by;
          const double above = surface_foot(triangle, x).gap;
          what = before - by;
          const double below = surface_foot(triangle, x).gap;
          what = before;
          return (above - below) / (2 * step);
        };
        EXPECT_NEAR(change(triangle.corner[c], step * way), dot(force, way), 1e-5) << c;
        const Vector turned = way - dot(way, triangle.normal[c]) * triangle.normal[c];
        EXPECT_NEAR(change(triangle.normal[c], step * turned), dot(turn, turned), 1e-5) << c;
      }
    }
  }
}

}  // namespace
}  // namespace physics
}  // namespace frontalis
