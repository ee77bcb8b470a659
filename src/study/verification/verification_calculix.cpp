// solids solved by voxels and by CalculiX with quadratic hexahedra

#include "study/verification/calculix.hpp"
#include "study/verification/verification_cases.hpp"

#include <cmath>

namespace frontalis
{
namespace
{

constexpr double tiny = 1e-7;  // [m], between equal positions

using Point = std::array<double, 3>;

Point still(const Point&) { return {}; }

// sums the forces on the nodes for which the condition holds
Point force_on(const SolidState& state, const std::function<bool(const Point&)>& where)
{
  Point sum{};
  for (std::size_t n = 0; n < state.positions.size(); ++n)
    if (where(state.positions[n]))
      for (std::size_t axis = 0; axis < 3; ++axis)
        sum[axis] += state.forces[n][axis];
  return sum;
}

// displacement of the node at a point
Point displacement_at(const SolidState& state, const Point& point)
{
  for (std::size_t n = 0; n < state.positions.size(); ++n)
    if (const auto& p = state.positions[n];
        std::abs(p[0] - point[0]) + std::abs(p[1] - point[1]) + std::abs(p[2] - point[2]) < tiny)
      return state.displacements[n];
  return { { std::nan(""), std::nan(""), std::nan("") } };
}

struct Comparison
{
  std::string name;
  SolidProblem problem;
  std::array<int, 3> elements;
  std::vector<double> edges;     // of voxels [m]
  double period;                 // [s]
  bool second_is_small = false;  // the second figure is a small difference of stresses, and has no bound
  struct
  {
    std::string what, unit;
  } figure[2];
  std::function<std::array<double, 2>(const SolidState&)> figures;
};

Comparison stretched_block()
{
  Comparison c;
  c.name = "stretched block";
  c.problem.size = { { 20e-3, 10e-3, 10e-3 } };
  c.problem.materials = { neo_hookean(30e3, 0.45) };
  const auto end = [](const Point& p) { return p[0] > 20e-3 - tiny; };
  c.problem.holds = { { [](const Point& p) { return p[0] < tiny; }, { { true, true, true } }, still },
                      { end, { { true, true, true } }, [](const Point&) {
                         return Point{ { 10e-3, 0, 0 } };
                       } } };
  c.elements = { { 10, 6, 6 } };
  c.edges = { 2.5e-3, 1.25e-3 };
  c.period = 0.03;
  c.figure[0] = { "force", "N" };
  c.figure[1] = { "narrowing of the waist", "mm" };
  c.figures = [=](const SolidState& s) -> std::array<double, 2> {
    return { { force_on(s, end)[0], 1e3 * displacement_at(s, { { 10e-3, 0, 5e-3 } })[1] } };
  };
  return c;
}

Comparison bent_cantilever()
{
  Comparison c;
  c.name = "cantilever under gravity";
  c.problem.size = { { 50e-3, 10e-3, 10e-3 } };
  c.problem.materials = { neo_hookean(30e3, 0.45) };
  c.problem.holds = { { [](const Point& p) { return p[0] < tiny; }, { { true, true, true } }, still } };
  c.problem.gravity = { { 0, 0, -9.81 } };
  c.elements = { { 15, 4, 4 } };
  c.edges = { 5e-3, 2.5e-3, 1.25e-3 };
  c.period = 0.28;
  c.figure[0] = { "sinking of the end", "mm" };
  c.figure[1] = { "drawing in of the end", "mm" };
  c.figures = [](const SolidState& s) -> std::array<double, 2>
  {
    const Point u = displacement_at(s, { { 50e-3, 5e-3, 5e-3 } });
    return { { -1e3 * u[2], -1e3 * u[0] } };
  };
  return c;
}

Comparison twisted_column()
{
  Comparison c;
  c.name = "twisted column";
  c.problem.size = { { 30e-3, 10e-3, 10e-3 } };
  c.problem.materials = { neo_hookean(30e3, 0.45) };
  const auto end = [](const Point& p) { return p[0] > 30e-3 - tiny; };
  // a quarter turn about the column's axis
  const auto turn = [](const Point& p)
  {
    const double y = p[1] - 5e-3, z = p[2] - 5e-3;
    return Point{ { 0, -z - y, y - z } };
  };
  c.problem.holds = { { [](const Point& p) { return p[0] < tiny; }, { { true, true, true } }, still },
                      { end, { { true, true, true } }, turn } };
  c.elements = { { 12, 4, 4 } };
  c.edges = { 2.5e-3, 1.25e-3 };
  c.period = 0.03;
  c.figure[0] = { "torque", "N mm" };
  c.figure[1] = { "axial pull", "N" };
  c.second_is_small = true;
  c.figures = [=](const SolidState& s) -> std::array<double, 2>
  {
    double torque = 0;
    for (std::size_t n = 0; n < s.positions.size(); ++n)
      if (end(s.positions[n]))
        torque += (s.positions[n][1] + s.displacements[n][1] - 5e-3) * s.forces[n][2] -
                  (s.positions[n][2] + s.displacements[n][2] - 5e-3) * s.forces[n][1];
    return { { 1e3 * torque, force_on(s, end)[0] } };
  };
  return c;
}

Comparison indented_slab()
{
  Comparison c;
  c.name = "indented slab";
  c.problem.size = { { 20e-3, 20e-3, 10e-3 } };
  c.problem.materials = { neo_hookean(20e3, 0.45), neo_hookean(120e3, 0.45) };
  c.problem.material = [](const Point& p) { return p[2] > 7.5e-3 ? 1 : 0; };
  const auto patch = [](const Point& p) { return p[2] > 10e-3 - tiny && p[0] < 5e-3 + tiny && p[1] < 5e-3 + tiny; };
  c.problem.holds = { { [](const Point& p) { return p[2] < tiny; }, { { true, true, true } }, still },
                      { [](const Point& p) { return p[0] < tiny && p[2] > tiny; }, { { true, false, false } }, still },
                      { [](const Point& p) { return p[1] < tiny && p[2] > tiny; }, { { false, true, false } }, still },
                      { patch, { { false, false, true } }, [](const Point&) {
                         return Point{ { 0, 0, -2e-3 } };
                       } } };
  c.elements = { { 12, 12, 8 } };
  c.edges = { 2.5e-3, 1.25e-3, 0.625e-3 };
  c.period = 0.03;
  c.figure[0] = { "force on the patch", "N" };
  c.figure[1] = { "sinking 2.5 mm beside the patch", "mm" };
  c.figures = [=](const SolidState& s) -> std::array<double, 2> {
    return { { -4 * force_on(s, patch)[2], -1e3 * displacement_at(s, { { 7.5e-3, 0, 10e-3 } })[2] } };
  };
  return c;
}

}  // namespace

Finding verify_calculix(const VerificationSettings& settings)
{
  Finding finding;
  if (!calculix_is_there())
  {
    finding.skipped = "CalculiX (program ccx, Debian's package calculix-ccx) is not installed";
    return finding;
  }
  Plot plot = convergence_plot("Difference from CalculiX", "voxel edge [mm]", "relative difference [%]",
                               { 0.625, 1.25, 2.5, 5 }, { { 0.55, 5.7 } });
  for (const auto& c : { stretched_block(), bent_cantilever(), twisted_column(), indented_slab() })
  {
    const auto expected = c.figures(solve_by_calculix(c.problem, c.elements));
    Plot::Curve curves[2] = { { c.name + ": " + c.figure[0].what }, { c.name + ": " + c.figure[1].what } };
    for (const double edge : c.edges)
    {
      const auto found = c.figures(solve_by_voxels(c.problem, edge, c.period, settings.backend));
      for (const std::size_t f : { 0, 1 })
      {
        const bool bounded = edge == c.edges.back() && !(f == 1 && c.second_is_small);
        finding.checks.relative(c.name + ", " + readable(1e3 * edge) + " mm: " + c.figure[f].what, c.figure[f].unit,
                                expected[f], found[f], bounded ? 0.03 : std::nan(""));
        curves[f].add(1e3 * edge, 100 * finding.checks.back().error);
      }
    }
    for (const auto& curve : curves)
      if (!(c.second_is_small && &curve == curves + 1))
        plot.curves.push_back(curve);
  }
  finding.plots.emplace_back("calculix", plot);
  return finding;
}

}  // namespace frontalis
