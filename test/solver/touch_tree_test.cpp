#include "solver/contact/touch_tree.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>

namespace frontalis
{
namespace
{

using Tree = TouchTree<float>;
using Vector = Tree::Vector;

// Triangles on their own, with three vertices each.
struct Cloud
{
  std::vector<Tree::Triangle> triangles;
  Tree tree;

  void make(double span)
  {
    std::vector<Tree::Corners> corners;
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(triangles.size()); ++t)
      corners.push_back({ { 3 * t, 3 * t + 1, 3 * t + 2 } });
    tree.make(triangles, corners, span);
  }
  void place(double reach)
  {
    tree.place(reach, [&](std::int32_t t) { return triangles[t]; });
  }
  std::set<std::int32_t> near(const Vector& p, const Vector& normal) const
  {
    std::set<std::int32_t> visited;
    tree.near(plain_touch_kernels<float>(), p, normal,
              [&](std::int32_t t) { EXPECT_TRUE(visited.insert(t).second) << "twice " << t; });
    return visited;
  }
};

class Chance
{
public:
  double operator()(double least, double most) { return std::uniform_real_distribution<double>(least, most)(random_); }
  Vector vector(double size) { return { (*this)(-size, size), (*this)(-size, size), (*this)(-size, size) }; }
  Vector direction()
  {
    const Vector v = vector(1);
    return norm(v) < 0.1 ? direction() : (1 / norm(v)) * v;
  }
  // A triangle of any size up to 3 mm whose normals deviate from that of its plane by up to 50 degrees.
  Tree::Triangle triangle()
  {
    Tree::Triangle t;
    const Vector middle = vector(0.01);
    const double size = (*this)(0.0003, 0.003);
    for (Vector& corner : t.at.corner)
      corner = middle + vector(size);
    const Vector area = cross(t.at.corner[1] - t.at.corner[0], t.at.corner[2] - t.at.corner[0]);
    const double bent = (*this)(0, 0.7);
    for (Vector& normal : t.at.normal)
    {
      const Vector turned = (1 / norm(area)) * area + bent * direction();
      normal = (1 / norm(turned)) * turned;
    }
    t.rim = (*this)(0, 1) < 0.2;
    return t;
  }

private:
  std::mt19937 random_{ 7 };
};

// With 1, 16, 17, 500 and 5,000 triangles the tree has one to four levels. The triangles have moved far from where the
// blocks were chosen. All that touch_search::may_touch() accepts must be visited, and few others.
TEST(TouchTree, visits_all_triangles_that_a_vertex_may_touch)
{
  constexpr double reach = 0.001;
  Chance chance;
  for (const int count : { 1, 16, 17, 500, 5000 })
  {
    Cloud cloud;
    for (int t = 0; t < count; ++t)
      cloud.triangles.push_back(chance.triangle());
    cloud.make(0.002);
    for (Tree::Triangle& t : cloud.triangles)
    {
      const Vector way = chance.vector(0.003);
      for (Vector& corner : t.at.corner)
        corner = corner + way;
    }
    cloud.place(reach);
    std::size_t wanted = 0, found = 0, tests = 0;
    for (int p = 0; p < 400; ++p)
    {
      const auto& near = cloud.triangles[p % count].at;
      const Vector at = (1.0 / 3) * (near.corner[0] + near.corner[1] + near.corner[2]) + chance.vector(0.002);
      const Vector normal = chance.direction();
      const std::set<std::int32_t> visited = cloud.near(at, normal);
      for (int t = 0; t < count; ++t)
      {
        const auto& [triangle, rim] = cloud.triangles[t];
        const auto foot = physics::surface_foot(triangle, at);
        bool inside = std::abs(foot.gap) < reach && dot(normal, triangle.normal[0]) < touch_search::same_way;
        const double beyond = rim ? 0.5 * reach : 0;
        for (int i = 0; i < 3; ++i)
          inside = inside && foot.weight[i] > -touch_search::foot_error - beyond * norm(foot.slope[i]);
        // The ball around a triangle limits how far from it a strongly bent surface is followed.
        const Vector centre = (1.0 / 3) * (triangle.corner[0] + triangle.corner[1] + triangle.corner[2]);
        inside = inside && norm(at - centre) < 1.5 * reach;
        wanted += inside ? 1 : 0;
        EXPECT_TRUE(!inside || visited.count(t) == 1) << "triangle " << t << " and vertex " << p;
      }
      found += visited.size();
      tests += count;
    }
    EXPECT_GT(wanted, 10U) << count;
    EXPECT_TRUE(count < 500 || found < tests / 50) << count << ' ' << found << ' ' << tests;
  }
}

TEST(TouchTree, visits_what_is_finite)
{
  Cloud cloud;
  for (int t = 0; t < 40; ++t)
  {
    const double x = 1e-5 * t;
    cloud.triangles.push_back(
        { { { { x, 0, 0 }, { x + 1, 0, 0 }, { x, 1, 0 } }, { { 0, 0, 1 }, { 0, 0, 1 }, { 0, 0, 1 } } }, false });
  }
  cloud.make(1);
  cloud.triangles[3].at.corner[1].y = std::nan("");
  cloud.triangles[20].at.corner[2].x = std::numeric_limits<double>::infinity();
  const Vector at{ 0.3, 0.3, 0.1 };
  EXPECT_TRUE(cloud.near(at, { 0, 0, -1 }).empty());  // the triangles have no places yet
  cloud.place(1);
  const std::set<std::int32_t> visited = cloud.near(at, { 0, 0, -1 });
  EXPECT_EQ(visited.size(), 38U);
  EXPECT_EQ(visited.count(3) + visited.count(20), 0U);
  EXPECT_TRUE(cloud.near({ std::nan(""), 0, 0 }, { 0, 0, -1 }).empty());
  EXPECT_TRUE(cloud.near(at, { 0, 0, 1 }).empty());
}

// Vertices and triangles move at random. The bound must not be below the way by which any two corners that are close to
// each other have approached each other; common motion, and motion of what is far away, must not count.
TEST(TouchTree, bounds_how_far_what_is_close_has_approached)
{
  constexpr double reach = 0.001, enough = 0.0002;
  Chance chance;
  Cloud cloud;
  for (int t = 0; t < 600; ++t)
    cloud.triangles.push_back(chance.triangle());
  cloud.make(0.002);
  const std::size_t vertices = 3 * cloud.triangles.size();
  const auto corner = [&](std::size_t v) { return cloud.triangles[v / 3].at.corner[v % 3]; };
  const auto bound = [&](const std::vector<Vector>& way)
  {
    const auto single = [](const Vector& v) {
      return std::array<float, 3>{ { static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z) } };
    };
    return cloud.tree.approach(
        plain_touch_kernels<float>(), reach, enough, [&](std::int32_t v) { return single(corner(v) + way[v]); },
        [&](std::int32_t v) { return single(way[v]); });
  };
  const Vector common{ 0.01, -0.02, 0.005 };
  EXPECT_LT(bound(std::vector<Vector>(vertices, common)), 1e-7);
  for (const double size : { 0.00001, 0.0001, 0.001 })
  {
    std::vector<Vector> way(vertices);
    for (Vector& w : way)
      w = common + chance.vector(size);
    double largest = 0;
    for (std::size_t v = 0; v < vertices; ++v)
      for (std::size_t w = 0; w < v; ++w)
        largest =
            std::max(largest, std::min(norm(way[v] - way[w]), reach - norm(corner(v) + way[v] - corner(w) - way[w])));
    EXPECT_GT(largest, 0.1 * size);
    EXPECT_GE(bound(way), std::min(largest, enough) - 1e-8) << size;
    EXPECT_LT(bound(way), 5 * size) << size;
  }
  // A stretch of space by 5 %: 1 mm between the far ends, but hardly any motion between close triangles.
  std::vector<Vector> stretched(vertices);
  for (std::size_t v = 0; v < vertices; ++v)
    stretched[v] = 0.05 * corner(v);
  EXPECT_LT(bound(stretched), 0.05 * std::sqrt(3.0) * (2 * 0.006 + reach));
}

}  // namespace
}  // namespace frontalis
