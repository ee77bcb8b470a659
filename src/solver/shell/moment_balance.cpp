#include "solver/shell/moment_balance.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace frontalis
{
namespace
{

using Vector = physics::Vec3<double>;

// The deflection of irregular plates under pressure is off by 0.4 % after 10 sweeps, and by as much after 100.
constexpr int sweeps = 10;

// Largest norm of Z. Energies are positive below 1, and at most 1 + this number times those without a change.
constexpr double largest_change = 0.8;

// Cosine of the angle between the bending vectors of two edges of the shell, above which they count as parallel. It
// allows edges to differ by 8 to 11 degrees, depending on Poisson's ratio.
constexpr double parallel = 0.98;

// A triangle whose bending acts on a vertex. Bending vectors are given in the axes of the triangle or in those of the
// vertex, which all triangles around it share when they are unfolded into a plane.
struct Around
{
  std::size_t triangle;
  std::size_t vertex;  // the vertex's index in the triangle
  Vector force;        // on the vertex, per uniform bending vector, with Z = 0
  double angle = std::nan("");
  double c = 1, s = 0;  // cosine and sine of twice the angle from the vertex's axes to those of the triangle

  Vector to_triangle(const Vector& b) const { return { b.x, c * b.y + s * b.z, c * b.z - s * b.y }; }
  Vector to_vertex(const Vector& b) const { return { b.x, c * b.y - s * b.z, c * b.z + s * b.y }; }
};

// The triangles around a vertex.
struct Ring
{
  std::vector<Around> around;
  std::vector<Vector> edges;  // unit bending vectors of the moment across each edge of the shell among the triangles
  bool balanced = true;
};

constexpr Vector unit[3] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };

// Adds a b^T + b a^T.
void add_product(Symmetric& m, const Vector& a, const Vector& b)
{
  const double p[3] = { a.x, a.y, a.z }, q[3] = { b.x, b.y, b.z };
  for (std::size_t j = 0, at = 0; j < 3; ++j)
    for (std::size_t k = j; k < 3; ++k)
      m[at++] += p[j] * q[k] + q[j] * p[k];
}

// The solution x of m x = r.
Vector solution(const Symmetric& m, const Vector& r)
{
  const Vector a = m * unit[0], b = m * unit[1], c = m * unit[2], across = cross(b, c);
  return (1 / dot(a, across)) * Vector{ dot(r, across), dot(a, cross(r, c)), dot(a, cross(b, r)) };
}

double norm_of(const Symmetric& m)
{
  return std::sqrt(m[0] * m[0] + m[3] * m[3] + m[5] * m[5] + 2 * (m[1] * m[1] + m[2] * m[2] + m[4] * m[4]));
}

// b without its part along the moment across the shell's edge.
Vector allowed(const Ring& ring, const Vector& b)
{
  return ring.edges.empty() ? b : b - dot(b, ring.edges[0]) * ring.edges[0];
}

class Balance
{
public:
  Balance(std::vector<BentTriangle>& triangles, double poisson) : triangles_(triangles), poisson_(poisson)
  {
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i)
        edge_[{ corner(t, i + 1), corner(t, i + 2) }] = { t, i };
    std::map<std::int32_t, Ring> rings;
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (std::size_t i = 0; i < 6; ++i)
        if (i < 3 || triangles[t].beyond[i - 3])
          rings[triangles[t].triangle.vertex[i]].around.push_back(
              { t, i, std::sqrt(triangles[t].area) * triangles[t].per_vertex(i) });
    for (auto& [vertex, ring] : rings)
    {
      unfold(ring);
      find_edges(ring);
      if (ring.balanced)
        rings_.push_back(std::move(ring));
    }
  }

  void sweep()
  {
    for (const Ring& ring : rings_)
      cancel_forces(ring);
    for (const Ring& ring : rings_)
      keep_energy(ring);
    for (BentTriangle& of : triangles_)
      if (const double size = norm_of(of.change); size > largest_change)
        for (double& element : of.change)
          element *= largest_change / size;
  }

private:
  std::int32_t corner(std::size_t triangle, std::size_t i) const { return triangles_[triangle].triangle.vertex[i % 3]; }

  // Finds the angles of the triangles of a ring, from neighbour to neighbour.
  void unfold(Ring& ring) const
  {
    std::vector<std::size_t> found{ 0 };
    ring.around[0].angle = 0;
    for (std::size_t at = 0; at < found.size(); ++at)
      for (std::size_t i = 0; i < 3; ++i)
      {
        const Around& from = ring.around[found[at]];
        const auto beside = edge_.find({ corner(from.triangle, i + 2), corner(from.triangle, i + 1) });
        if (beside == edge_.end())
          continue;
        const auto [triangle, edge] = beside->second;
        for (std::size_t a = 0; a < ring.around.size(); ++a)
          if (Around& to = ring.around[a]; to.triangle == triangle && std::isnan(to.angle))
          {
            // The edge runs in opposite directions, which are one for bending vectors.
            to.angle = from.angle + triangles_[from.triangle].direction[i] - triangles_[triangle].direction[edge];
            found.push_back(a);
          }
      }
    ring.balanced = found.size() == ring.around.size();
    for (Around& a : ring.around)
    {
      a.c = std::cos(2 * a.angle);
      a.s = std::sin(2 * a.angle);
    }
  }

  void find_edges(Ring& ring) const
  {
    for (const Around& a : ring.around)
      for (std::size_t i = 0; i < 3; ++i)
        if (const BentTriangle& of = triangles_[a.triangle]; !of.beyond[i])
        {
          const double mean = std::sqrt(0.5 * (1 + poisson_)), difference = std::sqrt(0.5 * (1 - poisson_));
          ring.edges.push_back(a.to_vertex(
              { mean, -difference * std::cos(2 * of.direction[i]), -difference * std::sin(2 * of.direction[i]) }));
          ring.balanced = ring.balanced && dot(ring.edges[0], ring.edges.back()) > parallel;
        }
  }

  // Cancels the forces of uniform bending vectors on a vertex.
  void cancel_forces(const Ring& ring)
  {
    Vector sum{ 0, 0, 0 };
    Symmetric gain{};
    for (const Around& a : ring.around)
    {
      sum = sum + a.to_vertex(a.force + triangles_[a.triangle].change * a.force);
      const Vector force = allowed(ring, a.to_vertex(a.force));
      const double diagonal = 0.5 * dot(a.force, a.force);
      add_product(gain, 0.25 * force, force);
      gain[0] += diagonal;
      gain[3] += diagonal;
      gain[5] += diagonal;
    }
    const Vector multiplier = solution(gain, allowed(ring, sum));
    for (const Around& a : ring.around)
      add_product(triangles_[a.triangle].change, -0.5 * a.to_triangle(multiplier), a.force);
  }

  // Keeps the energy of a uniform curvature of the triangles at a vertex.
  void keep_energy(const Ring& ring)
  {
    Vector mean[3] = { { 0, 0, 0 }, { 0, 0, 0 }, { 0, 0, 0 } };
    double area = 0;
    for (const Around& a : ring.around)
      if (a.vertex < 3)
      {
        const BentTriangle& of = triangles_[a.triangle];
        area += of.area;
        for (std::size_t k = 0; k < 3; ++k)
        {
          const Vector b = a.to_triangle(allowed(ring, unit[k]));
          mean[k] = mean[k] + of.area * allowed(ring, a.to_vertex(of.change * b));
        }
      }
    for (const Around& a : ring.around)
      if (a.vertex < 3)
        for (std::size_t k = 0; k < 3; ++k)
          add_product(triangles_[a.triangle].change, (-0.5 / area) * a.to_triangle(mean[k]), a.to_triangle(unit[k]));
  }

  std::vector<BentTriangle>& triangles_;
  double poisson_;
  std::map<std::pair<std::int32_t, std::int32_t>, std::pair<std::size_t, std::size_t>> edge_;
  std::vector<Ring> rings_;
};

}  // namespace

void balance_moments(std::vector<BentTriangle>& triangles, double poisson)
{
  Balance balance(triangles, poisson);
  for (int k = 0; k < sweeps; ++k)
    balance.sweep();
  for (BentTriangle& of : triangles)
    of.set_bending();
}

}  // namespace frontalis
