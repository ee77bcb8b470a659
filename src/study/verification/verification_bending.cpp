// bending with each hourglass control against a converged solution, and periods of vibration

#include "frontalis/study/equilibrium.hpp"
#include "frontalis/study/linear_statics.hpp"
#include "study/verification/verification_cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

constexpr double young = 1e5, height = 1, length = 10;

using Ratio = std::array<int, 3>;  // of a voxel's edges

struct Deflection
{
  double tip_force, own_weight;
};

// deflections of a square cantilever of `n` voxels through its height; forces are small, since only ratios matter
Deflection deflection(double poisson, int n, HourglassControl form, const Ratio& ratio,
                      Integration integration = Integration::one_point)
{
  const double unit = height / n / ratio[2];
  VoxelBox box;
  for (int axis = 0; axis < 3; ++axis)
  {
    box.spacing[axis] = unit * ratio[axis];
    box.size[axis] = static_cast<std::int32_t>(std::lround((axis == 0 ? length : height) / box.spacing[axis]));
  }
  box.materials = { neo_hookean(young, poisson) };
  Model model = voxel_model(box);
  model.hourglass = form;
  model.integration = integration;
  clamp(model, [](const auto& p) { return p[0] == 0; });
  const LinearStatics statics(model);
  const auto end = nodes_where(model, [&](const auto& p) { return p[0] > length - 0.1 * unit; });
  Vectors weight(model.nodes.size());
  for (const auto& corners : model.voxel_nodes)
    for (const auto node : corners)
      weight[node][2] += box.spacing[0] * box.spacing[1] * box.spacing[2] / 8;
  return { mean_displacement(statics.solve(face_forces(model, 0, box.size[0], { { 0, 0, 1 } })), end)[2],
           mean_displacement(statics.solve(weight), end)[2] };
}

}  // namespace

Finding verify_cantilever(const VerificationSettings&)
{
  Finding finding;
  Table table({ "ν", "edges", "voxels", "scalar [%]", "assumed strain [%]", "own weight: scalar [%]",
                "own weight: assumed strain [%]" });
  Table selective({ "ν", "1 voxel", "2", "4", "8" });
  const std::vector<Ratio> ratios{ { { 1, 1, 1 } }, { { 2, 1, 1 } }, { { 1, 2, 1 } }, { { 1, 1, 2 } },
                                   { { 2, 2, 1 } }, { { 2, 1, 2 } }, { { 1, 2, 2 } } };
  Plot plot{ "Deflection of a square cantilever, Poisson ratio 0.49", "voxels through the height [1]",
             "error of the deflection [%]" };
  plot.x_log = true;
  plot.x_range = { 0.9, 4.5 };
  plot.x_ticks = { 1, 2, 4 };
  plot.key = "below";
  for (const char* const name : { "scalar, cubes", "assumed strain, cubes", "assumed strain, 2:1 along the beam" })
    plot.curves.push_back({ name });
  for (const double poisson : { 0.3, 0.45, 0.49 })
  {
    const auto coarse = deflection(poisson, 4, HourglassControl::assumed_strain, ratios[0]);
    const auto fine = deflection(poisson, 8, HourglassControl::assumed_strain, ratios[0]);
    const Deflection converged{ fine.tip_force + (fine.tip_force - coarse.tip_force) / 3,
                                fine.own_weight + (fine.own_weight - coarse.own_weight) / 3 };
    double worst[2][2] = {};  // scalar, assumed strain; cubes, boxes
    for (const auto& ratio : ratios)
      for (const int n : { 1, 2, 4 })
      {
        if (n * ratio[2] < ratio[1])
          continue;
        double error[2], weight[2];
        for (const auto form : hourglass_forms)
        {
          const auto found = deflection(poisson, n, form, ratio);
          const auto f = static_cast<int>(form);
          error[f] = 100 * (found.tip_force / converged.tip_force - 1);
          weight[f] = 100 * (found.own_weight / converged.own_weight - 1);
          double& most = worst[f][ratio != ratios[0]];
          most = std::max(most, std::abs(error[f]));
          if (poisson == 0.49 && (ratio == ratios[0] || (f == 1 && ratio == ratios[1])))
          {
            auto& curve = plot.curves[ratio == ratios[0] ? f : 2];
            curve.add(n, error[f]);
          }
        }
        const std::string edges = fmt::format("{}", fmt::join(ratio, ""));
        table.add({ poisson, edges, static_cast<double>(n), std::round(100 * error[0]) / 100,
                    std::round(100 * error[1]) / 100, std::round(100 * weight[0]) / 100,
                    std::round(100 * weight[1]) / 100 });
      }
    std::vector<Table::Cell> row{ poisson };
    for (const int n : { 1, 2, 4, 8 })
      row.emplace_back(
          std::round(
              1e4 *
              (deflection(poisson, n, HourglassControl::scalar, ratios[0], Integration::selective_reduced).tip_force /
                   converged.tip_force -
               1)) /
          100);
    selective.add(row);
    const std::string at = ", ν = " + readable(poisson);
    finding.checks.absolute("worst error, scalar, cubes" + at, "%", 0, worst[0][0], 7);
    finding.checks.absolute("worst error, assumed strain, cubes" + at, "%", 0, worst[1][0], 3);
    finding.checks.absolute("worst error, assumed strain, 2:1" + at, "%", 0, worst[1][1], 6);
  }
  finding.tables.emplace_back("Error of the deflection under a force at the end and under the beam's own weight",
                              table);
  finding.tables.emplace_back(
      "Selective reduced integration (eight points, no hourglass control) on cubes, error under a force at the "
      "end [%]",
      selective);
  finding.plots.emplace_back("cantilever", plot);
  return finding;
}

namespace
{

// period of a bar that starts with these velocities, from the zero crossings of its end
double measured_period(const Model& model, const VerificationSettings& settings, const Vectors& velocities,
                       const std::vector<std::int32_t>& end, int axis, double guess)
{
  const auto solver = make_solver(std::make_shared<const Model>(model), { settings.backend, 1, 0 });
  solver->set_velocities(velocities);
  const double interval = guess / 200;
  double before = 0, first = 0;
  int crossings = 0;
  constexpr int wanted = 7;  // zero crossings of three periods
  for (int sample = 1; sample < 200 * 8; ++sample)
  {
    solver->advance(interval, solver->controls());
    Vectors u;
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

Finding verify_vibration(const VerificationSettings& settings)
{
  Finding finding;
  const double pi = std::acos(-1.0);
  for (const auto form : hourglass_forms)
    for (const int n : { 2, 4, 8 })
    {
      Model model = voxel_model({ { 10 * n, 1, n } }, 0.02 / n, neo_hookean(2e6, 0.3975));
      model.hourglass = form;
      prescribe(model, nodes_where(model, [](const auto&) { return true; }), { { false, true, false } });
      prescribe(model, nodes_where(model, [](const auto& p) { return p[0] == 0; }), { { true, true, true } });
      Vectors velocities(model.nodes.size());
      for (std::size_t node = 0; node < velocities.size(); ++node)
        velocities[node][2] = 1e-3 * (1 - std::cos(0.5 * pi * rest_position(model, node)[0] / 0.2));
      const auto end = nodes_where(model, [](const auto& p) { return p[0] > 0.1999; });
      finding.checks.relative(fmt::format("strip, {} voxels, {}", n, name_of(form)), "s", 0.25403,
                              measured_period(model, settings, velocities, end, 2, 0.254),
                              n > 2 ? 0.015 : std::nan(""));
    }
  Model model = voxel_model({ { 80, 2, 2 } }, 2.5e-3, neo_hookean(2e6, 0.3975));
  prescribe(model, nodes_where(model, [](const auto& p) { return p[0] == 0; }), { { true, false, false } });
  prescribe(model, nodes_where(model, [](const auto& p) { return p[0] == 0 && p[1] == 0; }),
            { { false, true, false } });
  prescribe(model, nodes_where(model, [](const auto& p) { return p[0] == 0 && p[2] == 0; }),
            { { false, false, true } });
  Vectors velocities(model.nodes.size());
  for (std::size_t node = 0; node < velocities.size(); ++node)
    velocities[node][0] = 1e-3 * std::sin(0.5 * pi * rest_position(model, node)[0] / 0.2);
  const auto end = nodes_where(model, [](const auto& p) { return p[0] > 0.1999; });
  const double expected = 4 * 0.2 * std::sqrt(1000 / 2e6);
  finding.checks.relative("bar along itself", "s", expected,
                          measured_period(model, settings, velocities, end, 0, expected), 0.003);
  return finding;
}

}  // namespace frontalis
