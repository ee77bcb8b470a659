// The law of a shell: forces as the gradient of the energy, rigid motions, energies of plates.

#include "frontalis/solver/shell_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace frontalis
{
namespace
{

using Vector = physics::Vec3<double>;
using Vertices = std::array<Vector, 6>;

constexpr double young = 1e6, poisson = 0.4, thickness = 1e-4, edge = 1e-3;

// An irregular triangle and its neighbours, nearly flat.
Vertices patch()
{
  return { { { 0, 0, 0 },
             { edge, 1e-4, 0.5e-4 },
             { 3e-4, 0.9e-3, 0 },
             { 1.2e-3, 1e-3, 1e-4 },
             { -0.6e-3, 0.7e-3, -1e-4 },
             { 0.5e-3, -0.8e-3, 0.7e-4 } } };
}

ShellMesh::Triangle triangle(const Vertices& x)
{
  return shell_triangle(x, { true, true, true }, thickness, young, poisson);
}

physics::ShellReaction<double> forces(const ShellMesh::Triangle& t, const Vertices& rest, const Vertices& now)
{
  Vector u[6];
  for (std::size_t i = 0; i < 6; ++i)
    u[i] = now[i] - rest[i];
  return physics::shell_forces(t.rest, u);
}

double energy(const ShellMesh::Triangle& t, const Vertices& rest, const Vertices& now)
{
  const auto out = forces(t, rest, now);
  return out.membrane + out.bending;
}

double& component(Vector& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

Vertices moved(Vertices x, double by, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-by, by);
  for (Vector& v : x)
    v = v + Vector{ any(random), any(random), any(random) };
  return x;
}

// Rotates a vector about an axis that is not a coordinate axis.
Vector turned(const Vector& v, double angle)
{
  const double s = std::sqrt(1.0 / 3);
  const Vector axis{ s, s, -s };
  return std::cos(angle) * v + std::sin(angle) * cross(axis, v) + ((1 - std::cos(angle)) * dot(axis, v)) * axis;
}

TEST(ShellLaw, forces_are_minus_the_gradient_of_the_energy)
{
  const Vertices rest = patch();
  const ShellMesh::Triangle t = triangle(rest);
  for (const double by : { 1e-6, 1e-4, 3e-4 })
    for (unsigned seed = 1; seed < 6; ++seed)
    {
      Vertices now = moved(rest, by, seed);
      auto out = forces(t, rest, now);
      double largest = 0;
      for (const Vector& f : out.force)
        largest = std::max(largest, norm(f));
      const double step = 1e-9;
      for (std::size_t v = 0; v < 6; ++v)
        for (int axis = 0; axis < 3; ++axis)
        {
          const double at = component(now[v], axis);
          component(now[v], axis) = at + step;
          const double above = energy(t, rest, now);
          component(now[v], axis) = at - step;
          const double below = energy(t, rest, now);
          component(now[v], axis) = at;
          EXPECT_NEAR(component(out.force[v], axis), (below - above) / (2 * step), 1e-4 * largest) << by << ' ' << v;
        }
    }
}

TEST(ShellLaw, rigid_motions_cost_nothing_and_forces_turn_with_the_shell)
{
  const Vertices rest = patch(), bent = moved(rest, 2e-4, 7);
  const ShellMesh::Triangle t = triangle(rest);
  const auto before = forces(t, rest, bent);
  for (const double angle : { 0.3, 1.5, 3.0 })
  {
    Vertices still = rest, now = bent;
    for (std::size_t i = 0; i < 6; ++i)
    {
      still[i] = turned(rest[i], angle) + Vector{ 1e-2, -2e-2, 5e-3 };
      now[i] = turned(bent[i], angle) + Vector{ 1e-2, -2e-2, 5e-3 };
    }
    const auto none = forces(t, rest, still), after = forces(t, rest, now);
    EXPECT_LT(none.membrane + none.bending, 1e-20);
    EXPECT_NEAR(after.membrane, before.membrane, 1e-10 * before.membrane);
    EXPECT_NEAR(after.bending, before.bending, 1e-10 * before.bending);
    for (std::size_t i = 0; i < 6; ++i)
    {
      EXPECT_LT(norm(none.force[i]), 1e-12);
      EXPECT_LT(norm(after.force[i] - turned(before.force[i], angle)), 1e-10);
    }
  }
}

TEST(ShellLaw, forces_add_up_to_no_force_and_no_moment)
{
  const Vertices rest = patch(), now = moved(rest, 3e-4, 11);
  const auto out = forces(triangle(rest), rest, now);
  Vector force{ 0, 0, 0 }, moment{ 0, 0, 0 };
  double sum = 0;
  for (std::size_t i = 0; i < 6; ++i)
  {
    force = force + out.force[i];
    moment = moment + cross(now[i], out.force[i]);
    sum += norm(out.force[i]);
  }
  EXPECT_LT(norm(force), 1e-12 * sum);
  EXPECT_LT(norm(moment), 1e-12 * sum * edge);
}

TEST(ShellLaw, a_strained_membrane_has_the_energy_of_plane_stress)
{
  const Vertices rest = patch();
  const ShellMesh::Triangle t = triangle(rest);
  // Unit vectors in the plane of the triangle, and its normal.
  const Vector e1 = (1 / norm(rest[1])) * rest[1], area = cross(rest[1], rest[2]), n = (1 / norm(area)) * area;
  const Vector e2 = cross(n, e1);
  const double a = 0.02, b = -0.05, shear = 0.01;
  Vertices now = rest;
  for (std::size_t i = 0; i < 3; ++i)
  {
    const double x = dot(rest[i], e1), y = dot(rest[i], e2);
    now[i] = rest[i] + (a * x + shear * y) * e1 + (b * y + shear * x) * e2;
  }
  const double mu = young / (2 * (1 + poisson)), lambda = young * poisson / (1 - poisson * poisson);
  const double expected =
      0.5 * norm(area) * thickness * (mu * (a * a + b * b + 2 * shear * shear) + 0.5 * lambda * (a + b) * (a + b));
  EXPECT_NEAR(forces(t, rest, now).membrane, expected, 1e-9 * expected);
}

// A triangle of any shape that is flat at rest is bent to a paraboloid with the curvatures k1, k2 along any directions.
TEST(ShellLaw, a_bent_triangle_has_the_energy_of_a_plate)
{
  Vertices rest = patch();
  for (Vector& v : rest)
    v.z = 0;
  const ShellMesh::Triangle t = triangle(rest);
  const double plate = young * std::pow(thickness, 3) / (12 * (1 - poisson * poisson));
  const double area = 0.5 * norm(cross(rest[1], rest[2]));
  for (const auto& [k1, k2] : { std::make_pair(1.0, 0.0), std::make_pair(1.0, 1.0), std::make_pair(1.0, -1.0) })
    for (const double angle : { 0.0, 0.4, 1.3 })
    {
      Vertices now = rest;
      for (Vector& v : now)
      {
        const double x = std::cos(angle) * v.x + std::sin(angle) * v.y,
                     y = std::cos(angle) * v.y - std::sin(angle) * v.x;
        v.z = 0.5 * (k1 * x * x + k2 * y * y);
      }
      const double expected = 0.5 * plate * area * (k1 * k1 + k2 * k2 + 2 * poisson * k1 * k2);
      EXPECT_NEAR(forces(t, rest, now).bending, expected, 0.005 * expected) << k1 << ' ' << k2 << ' ' << angle;
    }
}

// Unless the triangle nearly collapses, its stiffness along any direction is below the bound at rest.
TEST(ShellLaw, the_bound_of_stiffness_holds_when_stretched_and_compressed)
{
  const Vertices rest = patch();
  const ShellMesh::Triangle t = triangle(rest);
  std::mt19937 random(3);
  std::normal_distribution<double> any;
  for (const double stretch : { 0.5, 0.8, 1.0, 1.5, 2.5 })
    for (int attempt = 0; attempt < 20; ++attempt)
    {
      Vertices now = rest, way{};
      double squared = 0;
      for (std::size_t i = 0; i < 6; ++i)
      {
        now[i].x *= stretch;
        now[i].y /= std::sqrt(stretch);
        way[i] = { any(random), any(random), any(random) };
        squared += dot(way[i], way[i]);
      }
      const double step = 1e-8;
      Vertices above = now, below = now;
      for (std::size_t i = 0; i < 6; ++i)
      {
        above[i] = now[i] + step * way[i];
        below[i] = now[i] - step * way[i];
      }
      const auto up = forces(t, rest, above), down = forces(t, rest, below);
      double curvature = 0;
      for (std::size_t i = 0; i < 6; ++i)
        curvature -= dot(up.force[i] - down.force[i], way[i]) / (2 * step);
      EXPECT_LT(curvature, (t.membrane + t.bending) * squared) << stretch;
    }
}

// At an edge where the layer ends, a triangle has the energy of a plate in states whose moment does not pass the edge.
TEST(ShellLaw, no_moment_passes_an_edge_at_which_the_layer_ends)
{
  Vertices rest = patch();
  for (Vector& v : rest)
    v.z = 0;
  rest[2] = { 0.05e-3, edge, 0 };
  const ShellMesh::Triangle ends = shell_triangle(rest, { false, true, true }, thickness, young, poisson);
  const Vector along = (1 / norm(rest[2] - rest[1])) * (rest[2] - rest[1]), across{ along.y, -along.x, 0 };
  const double plate = young * std::pow(thickness, 3) / (12 * (1 - poisson * poisson));
  const double area = 0.5 * norm(cross(rest[1] - rest[0], rest[2] - rest[0]));
  for (const double twist : { 0.0, 0.7, -2.0 })
  {
    const double bent = 0.1, anticlastic = -poisson * bent;
    Vertices now = rest;
    for (Vector& v : now)
    {
      const double s = dot(v, along), n = dot(v, across);
      v.z = 0.5 * (bent * s * s + anticlastic * n * n) + twist * bent * s * n;
    }
    const double expected =
        0.5 * plate * area * (bent * bent * (1 - poisson * poisson) + 2 * (1 - poisson) * twist * twist * bent * bent);
    EXPECT_NEAR(forces(ends, rest, now).bending, expected, 0.01 * expected) << twist;
    now[3].z += 1e-4;
    EXPECT_NEAR(forces(ends, rest, now).bending, expected, 0.01 * expected) << "the missing vertex counts";
  }
}

}  // namespace
}  // namespace frontalis
