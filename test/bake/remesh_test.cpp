// Surfaces that are only shown get fewer triangles, where they are flat.

#include "bake/mesh/remesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <utility>

namespace frontalis
{
namespace
{

constexpr int edges = 60;
constexpr double size = 60e-3;      // [m]
constexpr double radius = 20e-3;    // [m] half the height of the cylinder
constexpr double tolerance = 1e-4;  // [m]

/// Height of a sheet that is flat for x < 0 and part of an elliptic cylinder beyond [m].
double height(double x) { return x < 0 ? 0 : std::sqrt(radius * radius - x * x / 4) - radius; }

TriangleMesh sheet()
{
  TriangleMesh mesh;
  for (int i = 0; i <= edges; ++i)
    for (int j = 0; j <= edges; ++j)
    {
      const double x = size * (double(i) / edges - 0.5), y = size * (double(j) / edges - 0.5);
      mesh.vertices.push_back({ { x, y, height(x) } });
    }
  for (int i = 0; i < edges; ++i)
    for (int j = 0; j < edges; ++j)
    {
      const std::int32_t a = i * (edges + 1) + j, b = a + edges + 1;
      mesh.triangles.push_back({ { a, b, b + 1 } });
      mesh.triangles.push_back({ { a, b + 1, a + 1 } });
    }
  return mesh;
}

/// The edges that belong to one triangle, by the places of their ends; each with its number of triangles.
std::map<std::pair<Vector3, Vector3>, int> border(const TriangleMesh& mesh)
{
  std::map<std::pair<Vector3, Vector3>, int> count;
  for (const auto& t : mesh.triangles)
    for (int c = 0; c < 3; ++c)
      ++count[std::minmax(mesh.vertices[t[c]], mesh.vertices[t[(c + 1) % 3]])];
  for (auto edge = count.begin(); edge != count.end();)
    edge = edge->second == 1 ? std::next(edge) : count.erase(edge);
  return count;
}

TEST(Remesh, a_flat_surface_needs_fewer_triangles)
{
  const TriangleMesh before = sheet(), after = with_fewer_triangles(before, tolerance);
  EXPECT_LT(6 * after.triangles.size(), before.triangles.size());
  EXPECT_EQ(border(after), border(before)) << "borders join other surfaces";
  for (const Vector3& v : after.vertices)
    EXPECT_NEAR(v[2], height(v[0]), tolerance);
  double area = 0;
  for (const auto& t : after.triangles)
  {
    const Vector3 &a = after.vertices[t[0]], &b = after.vertices[t[1]], &c = after.vertices[t[2]];
    const double twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    EXPECT_GT(twice, 0) << "a triangle is turned over";
    area += twice / 2;
  }
  EXPECT_NEAR(area, size * size, 1e-9 * size);
}

}  // namespace
}  // namespace frontalis
