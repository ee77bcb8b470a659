// Layers on a sphere whose expected displacements CalculiX computes, on a mesh that is fitted to the body.

#include "study/verification/boundary_bodies.hpp"
#include "study/verification/calculix.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <sstream>

namespace frontalis
{
namespace
{

constexpr double inner = 60.37e-3, outer = 65.37e-3, poisson = 0.49, young = 30e3, held_above = 0.8;

// A place on the outer arc: its angle from the z axis, and its displacement away from that axis and along it [m].
using ArcPoint = std::array<double, 3>;
using Arc = std::vector<ArcPoint>;

ArcPoint at_angle(const Arc& arc, double angle)
{
  const auto next = std::upper_bound(arc.begin() + 1, arc.end() - 1, angle,
                                     [](double value, const ArcPoint& point) { return value < point[0]; });
  const ArcPoint &a = *(next - 1), &b = *next;
  const double share = (angle - a[0]) / (b[0] - a[0]);
  return { { angle, a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2]) } };
}

// Solves a layer under gravity against z by depth x 15 * depth axisymmetric elements (CAX8R), which are smaller towards
// the edge of the mixed layer's held part, where stress is singular. CalculiX has its axis along y.
Arc solve_layer(bool mixed, double gravity, int depth)
{
  const int along = 15 * depth;
  const double edge_angle = std::acos(held_above), quarter = std::acos(0.0);
  const int first = static_cast<int>(std::lround(along * edge_angle / quarter));  // elements up to that edge
  // Positions of the corners of elements, and of the middles between them, by index in half elements.
  const auto middle = [](const auto& corner, int i) { return 0.5 * (corner(i - i % 2) + corner(i + i % 2)); };
  const auto corner_angle = [&](int i)
  {
    const double to_edge = 1 - 0.5 * i / first, beyond = 0.5 * (i - 2 * first) / (along - first);
    return i < 2 * first ? edge_angle * (1 - to_edge * to_edge) : edge_angle + (quarter - edge_angle) * beyond * beyond;
  };
  const auto corner_radius = [&](int j) { return inner + (outer - inner) * 0.25 * j * j / (depth * depth); };

  std::map<std::array<int, 2>, int> number;
  std::ostringstream nodes, elements, slides, held;
  for (auto* out : { &nodes, &slides })
    out->precision(12);
  Arc arc;
  std::vector<int> arc_nodes;
  for (int i = 0; i <= 2 * along; ++i)
    for (int j = 0; j <= 2 * depth; ++j)
    {
      if (i % 2 == 1 && j % 2 == 1)
        continue;
      const int n = static_cast<int>(number.size()) + 1;
      number[{ { i, j } }] = n;
      const double angle = middle(corner_angle, i), radius = middle(corner_radius, j);
      const double x = i == 0 ? 0 : std::sin(angle), y = i == 2 * along ? 0 : std::cos(angle);
      nodes << n << ',' << 1e3 * radius * x << ',' << 1e3 * radius * y << ",0\n";
      if (j == 0 && (!mixed || i <= 2 * first))
        held << n << ",1,2\n";
      else if (i == 0 || i == 2 * along)
        held << n << ",1\n";
      else if (j == 0)
        slides << "*EQUATION\n2\n" << n << ",1," << x << ',' << n << ",2," << y << '\n';
      if (j == 2 * depth)
      {
        arc.push_back({ { angle, 0, 0 } });
        arc_nodes.push_back(n);
      }
    }
  constexpr int corners[8][2] = { { 0, 0 }, { 2, 0 }, { 2, 2 }, { 0, 2 }, { 1, 0 }, { 2, 1 }, { 1, 2 }, { 0, 1 } };
  for (int i = 0; i < along; ++i)
    for (int j = 0; j < depth; ++j)
    {
      elements << i * depth + j + 1;
      for (const auto& corner : corners)
        elements << ',' << number.at({ { 2 * i + corner[0], 2 * j + corner[1] } });
      elements << '\n';
    }
  held << "*DLOAD\nE,GRAV," << 1e3 * gravity << ",0,-1,0\n";
  const auto solved =
      run_calculix("*NODE,NSET=NALL\n" + nodes.str() + "*ELEMENT,TYPE=CAX8R,ELSET=E\n" + elements.str() +
                       calculix_material("M", neo_hookean(young, poisson)) + "*SOLID SECTION,ELSET=E,MATERIAL=M\n" +
                       slides.str() + calculix_step("*BOUNDARY\n" + held.str()),
                   number.size());
  for (std::size_t p = 0; p < arc.size(); ++p)
  {
    const Point& u = solved.displacements[arc_nodes[p] - 1];
    arc[p] = { { arc[p][0], u[0], u[1] } };
  }
  return arc;
}

// RMS difference of two solutions over the outer sphere, divided by the RMS displacement.
double relative_difference(const Arc& coarse, const Arc& fine)
{
  double error = 0, size = 0;
  for (std::size_t p = 1; p < fine.size(); ++p)
  {
    const ArcPoint other = at_angle(coarse, fine[p][0]);
    const double area = std::cos(fine[p - 1][0]) - std::cos(fine[p][0]);
    for (const std::size_t c : { 1, 2 })
    {
      error += area * (fine[p][c] - other[c]) * (fine[p][c] - other[c]);
      size += area * fine[p][c] * fine[p][c];
    }
  }
  return std::sqrt(error / size);
}

}  // namespace

FittedLayer fitted_layer(bool mixed)
{
  const double gravity = mixed ? 0.1 : 1060;
  FittedLayer layer{ curved_layer(outer - inner, poisson, mixed, false), 0 };
  BoundaryBody& body = layer.body;
  body.name = mixed ? "layer, held and sliding" : "layer, held, sheared by 30 %";
  body.scene.gravity = { 0, 0, -gravity };
  if (mixed)
  {
    SceneConstraint held = body.scene.constraints[0];
    held.name = "held base";
    held.kind = SceneConstraint::Kind::rigid;
    held.crop.lower[2] = body.scene.constraints[0].crop.upper[2] = held_above * inner;
    body.scene.constraints.push_back(held);
  }
  body.bounds = { { 0.02, 0.01 } };
  const Arc arc = solve_layer(mixed, gravity, 8);
  layer.mesh_error = relative_difference(solve_layer(mixed, gravity, 4), arc);
  body.exact = [arc](const Point& p) -> Point
  {
    const double away = std::hypot(p[0], p[1]);
    const ArcPoint u = at_angle(arc, std::atan2(away, p[2]));
    return { { away > 0 ? u[1] * p[0] / away : 0, away > 0 ? u[1] * p[1] / away : 0, u[2] } };
  };
  return layer;
}

}  // namespace frontalis
