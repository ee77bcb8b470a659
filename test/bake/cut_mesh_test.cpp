#include "bake/mesh/surface_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace frontalis;

namespace
{

// a square of n x n cells of size 1 in the plane z = 0
TriangleMesh square(int n)
{
  TriangleMesh mesh;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      mesh.vertices.push_back({ { i + 0.0, j + 0.0, 0 } });
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
    {
      const int a = j * (n + 1) + i;
      mesh.triangles.push_back({ { a, a + 1, a + n + 2 } });
      mesh.triangles.push_back({ { a, a + n + 2, a + n + 1 } });
    }
  return mesh;
}

double area(const TriangleMesh& mesh)
{
  double sum = 0;
  for (const auto& t : mesh.triangles)
  {
    const auto [a, b, c] = corners(mesh, t);
    sum += 0.5 * (b - a).cross(c - a)[2];
  }
  return sum;
}

}  // namespace

TEST(CutMesh, KeepsTheAreaAndTheOrientationInsideTheRegion)
{
  Region region;
  region.lower = { 1.25, 0.5, -1 };
  region.upper = { 3.5, 2.75, 1 };
  const TriangleMesh part = cut_mesh(square(5), region);
  EXPECT_NEAR(area(part), 2.25 * 2.25, 1e-12);
  for (const auto& v : part.vertices)
    EXPECT_TRUE(to_box(region).contains(to_vector(v)));
}

TEST(CutMesh, NeighboursShareTheNewVertices)
{
  Region region;
  region.upper[0] = 2.3;
  const TriangleMesh part = cut_mesh(square(4), region);
  // the only border is the rim of a rectangle: all other edges belong to two triangles
  const auto rim = unbalanced_edges(part);
  double length = 0;
  for (const auto& edge : rim)
    length += (vertex(part, edge[1]) - vertex(part, edge[0])).norm();
  EXPECT_NEAR(length, 2 * (2.3 + 4), 1e-12);
}

TEST(CutMesh, LeavesAMeshAloneThatLiesInsideOrOnTheSides)
{
  const TriangleMesh whole = square(3);
  Region region;
  region.lower = { 0, 0, 0 };
  region.upper = { 3, 3, 0 };
  const TriangleMesh part = cut_mesh(whole, region);
  EXPECT_EQ(part.vertices, whole.vertices);
  EXPECT_EQ(part.triangles, whole.triangles);
}

TEST(ContinuedMesh, ReachesHalfABoxBeyondItsBorder)
{
  const TriangleMesh wide = continued(square(3), { 2, 2, 6 });
  EXPECT_NEAR(area(wide), 25, 1e-12);
  EXPECT_TRUE(bounding_box(wide).isApprox(Box(Vector3d(-1, -1, 0), Vector3d(4, 4, 0)), 1e-12));
  // oblique to the boxes by 45 degrees, where they are wider by the root of 2
  TriangleMesh turned = square(3);
  for (Vector3& v : turned.vertices)
    v = { (v[0] - v[1]) * std::sqrt(0.5), (v[0] + v[1]) * std::sqrt(0.5), 0 };
  EXPECT_NEAR(area(continued(turned, { 2, 2, 6 })), std::pow(3 + 2 * std::sqrt(2), 2), 1e-12);
}
