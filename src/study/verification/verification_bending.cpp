// Compares the bending of voxels under each hourglass control with a converged solution, and vibrations with theory.

#include "frontalis/physics/time_step.hpp"
#include "study/verification/verification_cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

constexpr double beam_young = 1e5, beam_height = 1, beam_length = 10;  // [Pa], [m], [m]

using Ratio = std::array<int, 3>;  // proportions of a voxel's edges

struct Deflection
{
  double tip_force, own_weight;  // mean deflection of the end under each of the two loads [m]
};

// Deflections of a square cantilever by linear statics, with `n` voxels through its height. Only their ratios are used.
Deflection deflection(double poisson, int n, HourglassControl form, const Ratio& ratio,
                      Integration integration = Integration::one_point)
{
  const double unit = beam_height / n / ratio[2];
  VoxelBox box{ {}, {}, { neo_hookean(beam_young, poisson) } };
  for (int axis = 0; axis < 3; ++axis)
  {
    box.spacing[axis] = unit * ratio[axis];
    box.size[axis] =
        static_cast<std::int32_t>(std::lround((axis == 0 ? beam_length : beam_height) / box.spacing[axis]));
  }
  Model model = voxel_model(box);
  model.hourglass = form;
  model.integration = integration;
  hold(model, [](const auto& p) { return p[0] == 0; });
  const LinearStatics statics(model);
  const auto end = nodes_where(model, [&](const auto& p) { return p[0] > beam_length - 0.1 * unit; });
  Vectors weight(model.nodes.size());
  for (const auto& corners : model.voxel_nodes)
    for (const auto node : corners)
      weight[node][2] += box.spacing[0] * box.spacing[1] * box.spacing[2] / 8;
  return { mean_displacement(statics.solve(face_forces(model, 0, box.size[0], { { 0, 0, 1 } })), end)[2],
           mean_displacement(statics.solve(weight), end)[2] };
}

}  // namespace

void verify_cantilever(const Backend&, Finding& finding)
{
  Table table({ "ν", "edges", "voxels", "scalar [%]", "assumed strain [%]", "own weight: scalar [%]",
                "own weight: assumed strain [%]" });
  Table selective({ "ν", "1 voxel", "2", "4", "8" });
  const std::vector<Ratio> ratios{ { { 1, 1, 1 } }, { { 2, 1, 1 } }, { { 1, 2, 1 } }, { { 1, 1, 2 } },
                                   { { 2, 2, 1 } }, { { 2, 1, 2 } }, { { 1, 2, 2 } } };
  Plot plot = convergence_plot("Deflection of a square cantilever, Poisson ratio 0.49", "voxels through the height [1]",
                               "error of the deflection [%]", { 1, 2, 4 }, { { 0.9, 4.5 } }, false);
  plot.curves = { { "scalar, cubes" }, { "assumed strain, cubes" }, { "assumed strain, 2:1 along the beam" } };
  const auto hundredths = [](double percent) { return std::round(100 * percent) / 100; };
  for (const double poisson : { 0.3, 0.45, 0.49 })
  {
    const auto coarse = deflection(poisson, 4, HourglassControl::assumed_strain, ratios[0]);
    const auto fine = deflection(poisson, 8, HourglassControl::assumed_strain, ratios[0]);
    const Deflection converged{ fine.tip_force + (fine.tip_force - coarse.tip_force) / 3,
                                fine.own_weight + (fine.own_weight - coarse.own_weight) / 3 };
    double worst[2][2] = {};  // [scalar or assumed strain][cubes or boxes]
    for (const auto& ratio : ratios)
      for (const int n : { 1, 2, 4 })
      {
        if (n * ratio[2] < ratio[1])
          continue;
        const bool cubes = ratio == ratios[0];
        double error[2], weight[2];
        for (const int f : { 0, 1 })
        {
          const auto found = deflection(poisson, n, hourglass_forms[f], ratio);
          error[f] = 100 * (found.tip_force / converged.tip_force - 1);
          weight[f] = 100 * (found.own_weight / converged.own_weight - 1);
          worst[f][!cubes] = physics::larger_or_none(worst[f][!cubes], std::abs(error[f]));
          if (poisson == 0.49 && (cubes || (f == 1 && ratio == ratios[1])))
            plot.curves[cubes ? f : 2].add(n, error[f]);
        }
        table.add({ poisson, fmt::format("{}", fmt::join(ratio, "")), static_cast<double>(n), hundredths(error[0]),
                    hundredths(error[1]), hundredths(weight[0]), hundredths(weight[1]) });
      }
    std::vector<Table::Cell> row{ poisson };
    for (const int n : { 1, 2, 4, 8 })
    {
      const auto found = deflection(poisson, n, HourglassControl::scalar, ratios[0], Integration::selective_reduced);
      row.emplace_back(hundredths(100 * (found.tip_force / converged.tip_force - 1)));
    }
    selective.add(row);
    const std::string at = ", ν = " + readable(poisson);
    finding.checks.absolute("worst error, scalar, cubes" + at, "%", 0, worst[0][0], 7);
    finding.checks.absolute("worst error, assumed strain, cubes" + at, "%", 0, worst[1][0], 3);
    finding.checks.absolute("worst error, assumed strain, 2:1" + at, "%", 0, worst[1][1], 6);
  }
  finding.tables = {
    { "Error of the deflection under a force at the end and under the beam's own weight", table },
    { "Selective reduced integration (eight points, no hourglass control) on cubes, error under a force at the end [%]",
      selective }
  };
  finding.plots.emplace_back("cantilever", plot);
}

namespace
{

// Period [s] of a bar of length 0.2 m, from the zero crossings of its end's displacement. Nodes start with the velocity
// velocity(x / length) [m/s] along the axis. `guess`: the expected period.
double measured_period(const Model& model, const Backend& backend, int axis, double guess,
                       const std::function<double(double)>& velocity)
{
  const auto solver = solver_of(model, backend);
  Vectors u(model.nodes.size());
  for (std::size_t node = 0; node < u.size(); ++node)
    u[node][axis] = velocity(rest_position(model, node)[0] / 0.2);
  solver->set_velocities(u);
  const auto end = nodes_where(model, [](const auto& p) { return p[0] > 0.1999; });
  const double interval = guess / 200;
  double before = 0, first = 0;
  int crossings = 0;
  constexpr int wanted = 7;  // number of zero crossings, which span three periods
  for (int sample = 1; sample < 200 * 8; ++sample)
  {
    solver->advance(interval, solver->controls());
    solver->displacements(u);
    const double now = mean_displacement(u, end)[axis];
    if (before * now < 0)
    {
      const double time = (sample - now / (now - before)) * interval;
      first = crossings == 0 ? time : first;
      if (++crossings == wanted)
        return (time - first) / (0.5 * (wanted - 1));
    }
    before = now;
  }
  return std::nan("");
}

}  // namespace

void verify_vibration(const Backend& backend, Finding& finding)
{
  const double pi = std::acos(-1.0);
  const auto fix = [](Model& model, const Condition& where, const std::array<bool, 3>& components)
  { prescribe(model, nodes_where(model, where), components); };
  const auto start = [](const Point& p) { return p[0] == 0; };
  for (const auto form : hourglass_forms)
    for (const int n : { 2, 4, 8 })
    {
      Model model = voxel_model({ { 10 * n, 1, n } }, 0.02 / n, neo_hookean(2e6, 0.3975));
      model.hourglass = form;
      fix(model, [](const Point&) { return true; }, { { false, true, false } });
      fix(model, start, { { true, true, true } });
      const double period =
          measured_period(model, backend, 2, 0.254, [&](double x) { return 1e-3 * (1 - std::cos(0.5 * pi * x)); });
      finding.checks.relative(fmt::format("strip, {} voxels, {}", n, name_of(form)), "s", 0.25403, period,
                              n > 2 ? 0.015 : std::nan(""));
    }
  Model model = voxel_model({ { 80, 2, 2 } }, 2.5e-3, neo_hookean(2e6, 0.3975));
  fix(model, start, { { true, false, false } });
  fix(model, [](const Point& p) { return p[0] == 0 && p[1] == 0; }, { { false, true, false } });
  fix(model, [](const Point& p) { return p[0] == 0 && p[2] == 0; }, { { false, false, true } });
  const double expected = 4 * 0.2 * std::sqrt(1000 / 2e6);
  const double period =
      measured_period(model, backend, 0, expected, [&](double x) { return 1e-3 * std::sin(0.5 * pi * x); });
  finding.checks.relative("bar, axial vibration", "s", expected, period, 0.003);
}

}  // namespace frontalis
