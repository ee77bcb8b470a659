#include "bake/mesh/cluster_search.hpp"
#include "bake/mesh/surface.hpp"

#include "bake/scene_pieces.hpp"

#include <gtest/gtest.h>

#include <random>

namespace
{

using namespace frontalis;

TriangleMesh sphere_with_holes()
{
  TriangleMesh mesh = make_shape(*sphere_surface("ball", { 0, 0, 0 }, 1, 0.04).shape);
  join_vertices(mesh);
  // cut holes around three axes, one of them large
  std::vector<bool> keep;
  for (const Triangle& t : mesh.triangles)
  {
    const Vector3d v = vertex(mesh, t[0]);
    keep.push_back(v[2] < 0.8 && v[0] < 0.95 && v[1] > -0.97);
  }
  return keep_triangles(mesh, keep);
}

double exact_winding(const TriangleMesh& mesh, const Vector3d& p)
{
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
  {
    const auto [a, b, c] = corners(mesh, t);
    sum += winding_of_triangle(p, a, b, c);
  }
  return sum;
}

std::vector<Vector3d> points(std::size_t count, double reach)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-reach, reach);
  std::vector<Vector3d> list;
  for (std::size_t i = 0; i < count; ++i)
    list.push_back({ uniform(random), uniform(random), uniform(random) });
  return list;
}

TEST(WindingNumber, IsOneInsideAndZeroOutsideAClosedSurface)
{
  TriangleMesh mesh = make_shape(*sphere_surface("ball", { 0, 0, 0 }, 1, 0.05).shape);
  join_vertices(mesh);
  const TriangleTree tree(mesh);
  for (const Vector3d& p : points(500, 1.5))
  {
    const double radius = p.norm();
    if (radius > 0.98 && radius < 1.001)
      continue;
    EXPECT_NEAR(tree.winding_number(p), radius < 1 ? 1 : 0, 5e-3);
  }
}

TEST(WindingNumber, AgreesWithTheExactSumOnASphereWithHoles)
{
  const TriangleMesh mesh = sphere_with_holes();
  ASSERT_FALSE(unbalanced_edges(mesh).empty());
  const TriangleTree tree(mesh);
  double worst = 0;
  for (const Vector3d& p : points(2000, 1.5))
    worst = std::max(worst, std::abs(tree.winding_number(p) - exact_winding(mesh, p)));
  RecordProperty("worst", std::to_string(worst));
  EXPECT_LT(worst, 5e-3);
  EXPECT_GT(worst, 0);  // 0 would mean that the series expansion was never used
}

TEST(WindingNumber, VariationBoundHoldsAwayFromTheSurface)
{
  const PreparedSurface surface("ball", sphere_with_holes());
  ASSERT_FALSE(surface.closed());
  const double radius = 0.02;
  int checked = 0;
  for (const Vector3d& p : points(3000, 1.2))
  {
    if (surface.tree().closest(p).distance < 2 * radius)
      continue;
    const double bound = surface.winding_variation(p, radius);
    const double here = exact_winding(surface.mesh(), p);
    for (std::size_t a = 0; a < 3; ++a)
    {
      Vector3d q = p;
      q[a] += radius;
      ASSERT_LE(std::abs(exact_winding(surface.mesh(), q) - here), bound + 1e-12);
    }
    ++checked;
    if (checked == 300)
      break;
  }
  EXPECT_EQ(checked, 300);
}

TEST(WindingNumber, IsNearlyZeroFarAway)
{
  const TriangleMesh mesh = sphere_with_holes();
  const TriangleTree tree(mesh);
  for (const Vector3d& p : points(2000, 1.5))
    ASSERT_LT(std::abs(tree.winding_number({ p[0] + 5, p[1], p[2] })), 0.1);
}

TEST(ClusterSearch, FindsWhatTheTreeFinds)
{
  const TriangleMesh mesh = sphere_with_holes();
  const TriangleTree tree(mesh);
  ClusterSearch search(tree, 0.2);
  // clusters of various sizes, and with bounds that are met by many points and by few
  for (const Vector3d& middle : points(30, 1.5))
    for (const double reach : { 0.05, 0.3 })
      for (const Vector3d& p : points(20, reach))
        for (const double bound : { 1e300, 0.4, 0.05 })
        {
          const ClosestPoint found = search.closest(middle + p, bound), right = tree.closest(middle + p, bound);
          ASSERT_EQ(found.triangle, right.triangle);
          ASSERT_EQ(found.feature, right.feature);
          ASSERT_EQ(found.point, right.point);
          ASSERT_EQ(found.distance, right.distance);
        }
}

TEST(SurfaceDistance, IsExactWithTheRightSign)
{
  TriangleMesh mesh = make_shape(*box_surface("box", { 0, 0, 0 }, { 2, 2, 2 }, 0.3).shape);
  join_vertices(mesh);
  const PreparedSurface surface("box", mesh);
  ASSERT_TRUE(surface.closed());
  for (const Vector3d& p : points(2000, 2))
  {
    // the exact distance from a cube of half edge 1
    const Vector3d q{ std::abs(p[0]) - 1, std::abs(p[1]) - 1, std::abs(p[2]) - 1 };
    const Vector3d out{ std::max(q[0], 0.0), std::max(q[1], 0.0), std::max(q[2], 0.0) };
    const double expected = out.norm() + std::min(0.0, std::max({ q[0], q[1], q[2] }));
    const ClosestPoint closest = surface.tree().closest(p);
    EXPECT_NEAR(surface.signed_distance(p, closest), expected, 1e-12);
    EXPECT_EQ(surface.tree().closest(p, 0.999 * std::abs(expected)).triangle, -1);
  }
}

}  // namespace
