// Compares solutions of voxels with those of CalculiX with quadratic hexahedra.

#include "study/verification/calculix.hpp"
#include "study/verification/verification_cases.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <sstream>

namespace frontalis
{
namespace
{

using Lattice = std::array<int, 3>;  // position of a node in half elements, or number of elements per axis

constexpr std::array<bool, 3> everything{ { true, true, true } };

Point still(const Point&) { return {}; }

// A problem that this solver and CalculiX can both solve: a box of neo-Hookean materials, held and loaded.
struct SolidProblem
{
  // Prescribes the selected components of `displacement` [m] at nodes whose rest position [m] satisfies `where`.
  struct Hold
  {
    Condition where;
    std::array<bool, 3> components = everything;
    std::function<Point(const Point&)> displacement = still;
  };
  Point size;  // [m]
  std::vector<Material> materials;
  std::function<int(const Point&)> material;  // index of the material at a position [m]; not set: 0
  std::vector<Hold> holds;
  Point gravity{};  // [m/s2]
};

// A solution: for each node the rest position [m], the displacement [m] and the force of the supports [N].
struct SolidState
{
  Vectors positions, displacements, forces;
};

// Corners and edge midpoints of the element at the origin, in half elements and in CalculiX's order.
constexpr int element_nodes[20][3] = { { 0, 0, 0 }, { 2, 0, 0 }, { 2, 2, 0 }, { 0, 2, 0 }, { 0, 0, 2 },
                                       { 2, 0, 2 }, { 2, 2, 2 }, { 0, 2, 2 }, { 1, 0, 0 }, { 2, 1, 0 },
                                       { 1, 2, 0 }, { 0, 1, 0 }, { 1, 0, 2 }, { 2, 1, 2 }, { 1, 2, 2 },
                                       { 0, 1, 2 }, { 0, 0, 1 }, { 2, 0, 1 }, { 2, 2, 1 }, { 0, 2, 1 } };

// Returns the input file of CalculiX, in mm, N, MPa and t. `positions` receives its nodes [m].
std::string deck(const SolidProblem& problem, const Lattice& elements, Vectors& positions)
{
  std::map<Lattice, int> number;
  std::ostringstream nodes, solids, sections, held;
  for (auto* out : { &nodes, &solids, &sections, &held })
    out->precision(12);
  const auto position = [&](const Lattice& at)
  {
    std::array<double, 3> p;
    for (std::size_t axis = 0; axis < 3; ++axis)
      p[axis] = problem.size[axis] * at[axis] / (2 * elements[axis]);
    return p;
  };
  std::vector<std::ostringstream> of_material(problem.materials.size());
  int element = 0;
  for (int k = 0; k < elements[2]; ++k)
    for (int j = 0; j < elements[1]; ++j)
      for (int i = 0; i < elements[0]; ++i)
      {
        const int m = problem.material ? problem.material(position({ { 2 * i + 1, 2 * j + 1, 2 * k + 1 } })) : 0;
        auto& out = of_material[m];
        out << ++element;
        for (const auto& corner : element_nodes)
        {
          const Lattice at{ { 2 * i + corner[0], 2 * j + corner[1], 2 * k + corner[2] } };
          const auto entry = number.emplace(at, static_cast<int>(positions.size()) + 1);
          if (entry.second)
          {
            const auto p = position(at);
            positions.push_back(p);
            nodes << positions.size() << ',' << 1e3 * p[0] << ',' << 1e3 * p[1] << ',' << 1e3 * p[2] << '\n';
          }
          out << (&corner == element_nodes + 10 ? ",\n" : ",") << entry.first->second;
        }
        out << '\n';
      }
  for (std::size_t m = 0; m < problem.materials.size(); ++m)
  {
    const std::string name = fmt::to_string(m);
    solids << "*ELEMENT,TYPE=C3D20R,ELSET=E" << name << '\n' << of_material[m].str();
    sections << calculix_material("M" + name, problem.materials[m]) << "*SOLID SECTION,ELSET=E" << name << ",MATERIAL=M"
             << name << '\n';
  }
  for (std::size_t n = 0; n < positions.size(); ++n)
    for (const auto& hold : problem.holds)
      if (hold.where(positions[n]))
      {
        const auto u = hold.displacement(positions[n]);
        for (int axis = 0; axis < 3; ++axis)
          if (hold.components[axis])
            held << n + 1 << ',' << axis + 1 << ',' << axis + 1 << ',' << 1e3 * u[axis] << '\n';
      }
  const auto& g = problem.gravity;
  const double gravity = std::hypot(g[0], g[1], g[2]);
  for (std::size_t m = 0; gravity > 0 && m < problem.materials.size(); ++m)
    held << "*DLOAD\nE" << m << ",GRAV," << 1e3 * gravity << ',' << g[0] / gravity << ',' << g[1] / gravity << ','
         << g[2] / gravity << '\n';
  return "*NODE,NSET=NALL\n" + nodes.str() + solids.str() + sections.str() + calculix_step("*BOUNDARY\n" + held.str());
}

// Solves the problem by CalculiX with elements[0] x [1] x [2] quadratic hexahedra (C3D20R), hyperelastic, with large
// deformation.
SolidState solve_by_calculix(const SolidProblem& problem, const Lattice& elements)
{
  SolidState state;
  const std::string input = deck(problem, elements, state.positions);
  CalculixState solved = run_calculix(input, state.positions.size());
  state.displacements = std::move(solved.displacements);
  state.forces = std::move(solved.forces);
  return state;
}

// Solves the problem with voxels of edge `edge` [m], which must divide the box. `period`: see EquilibriumSettings.
SolidState solve_by_voxels(const SolidProblem& problem, double edge, double period, const Backend& backend)
{
  VoxelBox box{ {}, { { edge, edge, edge } }, problem.materials };
  for (std::size_t axis = 0; axis < 3; ++axis)
    box.size[axis] = static_cast<std::int32_t>(std::lround(problem.size[axis] / edge));
  if (problem.material)
    box.material = [&](const auto& v) {
      return problem.material({ { (v[0] + 0.5) * edge, (v[1] + 0.5) * edge, (v[2] + 0.5) * edge } });
    };
  Model model = voxel_model(box);
  model.hourglass = HourglassControl::assumed_strain;
  model.gravity = problem.gravity;
  SolidState state;
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
  {
    state.positions.push_back(rest_position(model, n));
    for (const auto& hold : problem.holds)
      if (hold.where(state.positions[n]))
        prescribe(model, { static_cast<std::int32_t>(n) }, hold.components, hold.displacement(state.positions[n]));
  }
  RestState rest = find_equilibrium(model, { backend, period, 5e-4 });
  state.displacements = std::move(rest.displacements);
  rest.solver->internal_forces(state.forces);
  return state;
}

constexpr double tiny = 1e-7;  // tolerance for equal positions [m]

// Sum of the forces on the nodes that fulfil a condition [N].
Point force_on(const SolidState& state, const Condition& where)
{
  Point sum{};
  for (std::size_t n = 0; n < state.positions.size(); ++n)
    if (where(state.positions[n]))
      for (std::size_t axis = 0; axis < 3; ++axis)
        sum[axis] += state.forces[n][axis];
  return sum;
}

// Displacement [m] of the node at a position; NaN if there is no node.
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
  Lattice elements;
  std::vector<double> edges;  // voxel edges [m]
  double period;              // period of the slowest vibration [s]
  std::array<std::string, 2> what, unit;
  std::function<std::array<double, 2>(const SolidState&)> figures;
  // True: the second of the two figures is a small difference of large stresses and therefore has no bound.
  bool second_is_small = false;
};

bool start(const Point& p) { return p[0] < tiny; }

std::function<Point(const Point&)> moved(const Point& by)
{
  return [by](const Point&) { return by; };
}

Comparison stretched_block()
{
  const auto end = [](const Point& p) { return p[0] > 20e-3 - tiny; };
  return { "stretched block",
           { { { 20e-3, 10e-3, 10e-3 } },
             { neo_hookean(30e3, 0.45) },
             {},
             { { start }, { end, everything, moved({ { 10e-3, 0, 0 } }) } } },
           { { 10, 6, 6 } },
           { 2.5e-3, 1.25e-3 },
           0.03,
           { { "force", "narrowing of the waist" } },
           { { "N", "mm" } },
           [=](const SolidState& s) -> std::array<double, 2> {
             return { { force_on(s, end)[0], 1e3 * displacement_at(s, { { 10e-3, 0, 5e-3 } })[1] } };
           } };
}

Comparison bent_cantilever()
{
  return { "cantilever under gravity",
           { { { 50e-3, 10e-3, 10e-3 } }, { neo_hookean(30e3, 0.45) }, {}, { { start } }, { { 0, 0, -9.81 } } },
           { { 15, 4, 4 } },
           { 5e-3, 2.5e-3, 1.25e-3 },
           0.28,
           { { "sinking of the end", "drawing in of the end" } },
           { { "mm", "mm" } },
           [](const SolidState& s) -> std::array<double, 2>
           {
             const Point u = displacement_at(s, { { 50e-3, 5e-3, 5e-3 } });
             return { { -1e3 * u[2], -1e3 * u[0] } };
           } };
}

Comparison twisted_column()
{
  const auto end = [](const Point& p) { return p[0] > 30e-3 - tiny; };
  const auto quarter_turn = [](const Point& p)
  {
    const double y = p[1] - 5e-3, z = p[2] - 5e-3;
    return Point{ { 0, -z - y, y - z } };
  };
  return {
    "twisted column",
    { { { 30e-3, 10e-3, 10e-3 } }, { neo_hookean(30e3, 0.45) }, {}, { { start }, { end, everything, quarter_turn } } },
    { { 12, 4, 4 } },
    { 2.5e-3, 1.25e-3 },
    0.03,
    { { "torque", "axial pull" } },
    { { "N mm", "N" } },
    [=](const SolidState& s) -> std::array<double, 2>
    {
      double torque = 0;
      for (std::size_t n = 0; n < s.positions.size(); ++n)
        if (end(s.positions[n]))
          torque += (s.positions[n][1] + s.displacements[n][1] - 5e-3) * s.forces[n][2] -
                    (s.positions[n][2] + s.displacements[n][2] - 5e-3) * s.forces[n][1];
      return { { 1e3 * torque, force_on(s, end)[0] } };
    },
    true
  };
}

Comparison indented_slab()
{
  const auto patch = [](const Point& p) { return p[2] > 10e-3 - tiny && p[0] < 5e-3 + tiny && p[1] < 5e-3 + tiny; };
  return { "indented slab",
           { { { 20e-3, 20e-3, 10e-3 } },
             { neo_hookean(20e3, 0.45), neo_hookean(120e3, 0.45) },
             [](const Point& p) { return p[2] > 7.5e-3 ? 1 : 0; },
             { { [](const Point& p) { return p[2] < tiny; } },
               { [](const Point& p) { return p[0] < tiny && p[2] > tiny; }, { { true, false, false } } },
               { [](const Point& p) { return p[1] < tiny && p[2] > tiny; }, { { false, true, false } } },
               { patch, { { false, false, true } }, moved({ { 0, 0, -2e-3 } }) } } },
           { { 12, 12, 8 } },
           { 2.5e-3, 1.25e-3, 0.625e-3 },
           0.03,
           { { "force on the patch", "sinking 2.5 mm beside the patch" } },
           { { "N", "mm" } },
           [=](const SolidState& s) -> std::array<double, 2> {
             return { { -4 * force_on(s, patch)[2], -1e3 * displacement_at(s, { { 7.5e-3, 0, 10e-3 } })[2] } };
           } };
}

}  // namespace

void verify_calculix(const Backend& backend, Finding& finding)
{
  if (!calculix_is_installed())
  {
    finding.skipped = calculix_is_missing;
    return;
  }
  Plot plot = convergence_plot("Difference from CalculiX", "voxel edge [mm]", "relative difference [%]",
                               { 0.625, 1.25, 2.5, 5 }, { { 0.55, 5.7 } });
  for (const auto& c : { stretched_block(), bent_cantilever(), twisted_column(), indented_slab() })
  {
    const auto expected = c.figures(solve_by_calculix(c.problem, c.elements));
    Plot::Curve curves[2] = { { c.name + ": " + c.what[0] }, { c.name + ": " + c.what[1] } };
    for (const double edge : c.edges)
    {
      const auto found = c.figures(solve_by_voxels(c.problem, edge, c.period, backend));
      for (const std::size_t f : { 0, 1 })
      {
        const bool bounded = edge == c.edges.back() && !(f == 1 && c.second_is_small);
        finding.checks.relative(c.name + ", " + readable(1e3 * edge) + " mm: " + c.what[f], c.unit[f], expected[f],
                                found[f], bounded ? 0.03 : std::nan(""));
        curves[f].add(1e3 * edge, 100 * finding.checks.back().error());
      }
    }
    plot.curves.insert(plot.curves.end(), curves, curves + (c.second_is_small ? 1 : 2));
  }
  finding.plots.emplace_back("calculix", plot);
}

}  // namespace frontalis
