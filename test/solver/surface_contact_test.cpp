#include "solver/contact/surface_contact.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace frontalis;
using Point = SurfaceTree::Point;

namespace
{

// Moves a point as the solver does: on its plane until slip (with `late`, limit) is used up, then on a new one.
class Walker
{
public:
  Walker(const SurfaceTree& tree, double distance, const Point& start, bool late = false)
      : contact_(tree, distance), p_(start), late_(late)
  {
  }

  const Point& step(const Point& by)
  {
    p_ = p_ + by;
    if (first_ || norm(p_ - reference_) > (late_ ? plane_.limit : plane_.slip))
    {
      plane_ = late_ ? contact_.renew<true>(p_) : contact_.renew(p_);
      reference_ = p_;
      first_ = false;
    }
    p_ = p_ - (dot(plane_.normal, p_) - plane_.height) * plane_.normal;
    return p_;
  }
  const Point& normal() const { return plane_.normal; }

private:
  SurfaceContact contact_;
  ContactPlane plane_;
  Point p_, reference_{ 0, 0, 0 };
  bool late_, first_ = true;
};

double error_of(bool late) { return late ? SurfaceContact::late_error : SurfaceContact::plane_error; }

double unsigned_distance(const SurfaceTree& tree, const Point& p)
{
  return std::sqrt(tree.closest(p, 1).squared_distance);
}

// A sheet in the plane z = 0 from x = -20 to 0 mm, of squares of 2 mm, with a triangle of zero area on an edge.
TriangleMesh sheet()
{
  TriangleMesh mesh;
  for (int j = 0; j <= 10; ++j)
    for (int i = 0; i <= 10; ++i)
      mesh.vertices.push_back({ { 2e-3 * (i - 10), 2e-3 * (j - 5), 0 } });
  for (int j = 0; j < 10; ++j)
    for (int i = 0; i < 10; ++i)
    {
      const int a = 11 * j + i;
      mesh.triangles.push_back({ { a, a + 1, a + 12 } });
      mesh.triangles.push_back({ { a, a + 12, a + 11 } });
    }
  mesh.triangles.push_back({ { 60, 61, 60 } });
  return mesh;
}

// A thin wedge whose edge lies along y at the origin and opens downwards.
TriangleMesh blade(double half_angle)
{
  TriangleMesh mesh;
  const double x = 20e-3 * std::sin(half_angle), z = -20e-3 * std::cos(half_angle);
  for (const double y : { -20e-3, 20e-3 })
    for (const double side : { -1.0, 0.0, 1.0 })
      mesh.vertices.push_back({ { side * x, y, side == 0 ? 0 : z } });
  mesh.triangles = { { { 0, 1, 3 } }, { { 1, 4, 3 } }, { { 1, 2, 4 } }, { { 2, 5, 4 } } };
  return mesh;
}

}  // namespace

TEST(SurfaceContact, GoesRoundTheRimOfAnOpenSurfaceAndBelowIt)
{
  const SurfaceTree tree(sheet());
  for (const auto& [distance, late] : { std::pair(1e-3, false), std::pair(-1e-3, false), std::pair(1e-3, true) })
  {
    Walker walker(tree, distance, { -1e-3, 0.3e-3, distance }, late);
    Point p{ 0, 0, 0 }, before{ -1e-3, 0.3e-3, distance };
    for (int i = 0; i < 1000; ++i)
    {
      // along the surface: outwards, around the rim and back on the other side
      const Point& n = walker.normal();
      p = walker.step(5e-6 * (i == 0 ? Point{ 1, 0, 0 } : Point{ n.z, 0, -n.x }));
      EXPECT_LT(norm(p - before), 20e-6) << i;
      EXPECT_NEAR(unsigned_distance(tree, p), 1e-3, error_of(late) + 0.02e-6) << i;
      before = p;
    }
    EXPECT_LT(p.x, -0.5e-3);
    EXPECT_NEAR(p.z, -distance, error_of(late) + 0.02e-6);
  }
}

TEST(SurfaceContact, PassesOverASharpRidge)
{
  for (const double half_angle : { 0.1, 0.5 })
    for (const auto& [distance, late] :
         { std::pair(0.0, false), std::pair(30e-6, false), std::pair(0.5e-3, false), std::pair(0.5e-3, true) })
    {
      const SurfaceTree tree(blade(half_angle));
      const Point side{ -std::cos(half_angle), 0, std::sin(half_angle) };
      const Point down{ std::sin(half_angle), 0, std::cos(half_angle) };
      const Point start = distance * side - 1e-3 * down;
      Walker walker(tree, distance, start, late);
      Point p = start, before = start;
      double worst = 0;
      for (int i = 0; i < 1500; ++i)
      {
        const Point& n = walker.normal();
        p = walker.step(2e-6 * (i == 0 ? down : Point{ n.z, 0, -n.x }));
        worst = std::max(worst, std::abs(unsigned_distance(tree, p) - distance));
        EXPECT_LT(norm(p - before), 20e-6) << i;
        before = p;
      }
      // and one step over the edge
      EXPECT_LT(worst, error_of(late) + 2e-6) << half_angle << " " << distance;
      EXPECT_GT(p.x, distance * std::cos(half_angle)) << half_angle << " " << distance;
    }
}

// A node between two walls stays with the wall on which it started, however near the other one comes.
TEST(SurfaceContact, KeepsToItsSheetBetweenTwo)
{
  TriangleMesh mesh = sheet();
  const auto sheet_vertices = static_cast<std::int32_t>(mesh.vertices.size());
  const auto sheet_triangles = mesh.triangles.size();
  for (std::int32_t v = 0; v < sheet_vertices; ++v)
  {
    const auto& below = mesh.vertices[static_cast<std::size_t>(v)];
    mesh.vertices.push_back({ { below[0], below[1], 1.2e-3 - 0.02 * (below[0] + 20e-3) } });
  }
  for (std::size_t t = 0; t < sheet_triangles; ++t)
  {
    const auto below = mesh.triangles[t];
    mesh.triangles.push_back({ { below[0] + sheet_vertices, below[2] + sheet_vertices, below[1] + sheet_vertices } });
  }
  const SurfaceTree tree(mesh);
  Walker walker(tree, 0.5e-3, { -19e-3, 0.2e-3, 0.5e-3 });
  for (int i = 0; i < 1800; ++i)
  {
    const Point p = walker.step({ 10e-6, 0, 0 });
    EXPECT_NEAR(p.z, 0.5e-3, 1e-9) << i;
  }
}

TEST(SurfaceContact, AnEmptySurfaceHoldsNothing)
{
  const SurfaceTree tree(TriangleMesh{});
  Walker walker(tree, 1e-3, { 0, 0, 0 });
  const Point p = walker.step({ 1e-3, 2e-3, 3e-3 });
  EXPECT_EQ(p.x, 1e-3);
  EXPECT_EQ(p.z, 3e-3);
}
