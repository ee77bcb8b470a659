// motions over time: viscous relaxation, the balance of energies, a million steps in single precision

#include "frontalis/study/equilibrium.hpp"
#include "study/verification/verification_cases.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

// shear force on the upper side of a block
double shear_force(Solver& solver, const Model& model)
{
  return internal_force(
      solver, nodes_where(model, [&](const auto& p) { return p[1] > (model.size[1] - 0.5) * model.spacing[1]; }))[0];
}

Model sheared_block(const std::array<double, 2>& share, const std::array<double, 2>& time)
{
  VoxelBox box;
  box.size = { { 3, 2, 2 } };
  box.materials = { neo_hookean(34e3, 0.49) };
  box.materials[0].viscous_share = share;
  box.materials[0].viscous_time = time;
  Model model = voxel_model(box);
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    prescribe(model, { static_cast<std::int32_t>(n) }, { { true, true, true } },
              { { 0.1 * rest_position(model, n)[1], 0, 0 } });
  return model;
}

// a bar under gravity that is held at one end
Model hanging_bar(const std::array<std::int32_t, 3>& size, double gravity)
{
  Model model = voxel_model(size, 1e-3, neo_hookean(34e3, 0.45));
  clamp(model, [](const auto& p) { return p[0] == 0; });
  model.gravity = { { gravity, 0, -0.3 * gravity } };
  return model;
}

}  // namespace

Finding verify_viscosity(const VerificationSettings& settings)
{
  Finding finding;
  Plot plot{ "Stress of a sheared block that is held", "time [s]", "stress over the elastic one [1]" };
  plot.x_log = true;
  plot.key = "bottom left";
  struct Series
  {
    const char* name;
    std::array<double, 2> share, time;
  };
  for (const auto& series : { Series{ "one term", { { 0.4, 0 } }, { { 0.02, 0 } } },
                              Series{ "two terms", { { 0.3, 0.2 } }, { { 0.01, 0.1 } } } })
  {
    const Model model = sheared_block(series.share, series.time);
    const auto elastic = make_solver(std::make_shared<const Model>(sheared_block({}, {})), { settings.backend, 1, 0 });
    const auto viscous = make_solver(std::make_shared<const Model>(model), { settings.backend, 1, 0 });
    elastic->advance(1e-4, elastic->controls());
    const double at_once = shear_force(*elastic, model);
    Plot::Curve theory{ std::string(series.name) + ", closed form", {}, {}, Plot::Style::line };
    Plot::Curve measured{ std::string(series.name) + ", solver", {}, {}, Plot::Style::points };
    const auto left = [&](double t)
    {
      double sum = 1;
      for (const std::size_t i : { 0, 1 })
        if (series.share[i] > 0)
          sum -= series.share[i] * (1 - std::exp(-t / series.time[i]));
      return sum;
    };
    for (double t = 1e-3; t < 1; t *= 1.1)
      theory.add(t, left(t));
    double now = 0;
    for (const double then : { 0.002, 0.01, 0.05, 0.2, 0.8 })
    {
      viscous->advance(then - now, viscous->controls());
      now = then;
      const double found = shear_force(*viscous, model) / at_once;
      measured.add(now, found);
      finding.checks.relative(std::string(series.name) + ", after " + readable(now) + " s", "1", left(now), found,
                              2e-3);
    }
    plot.curves.push_back(theory);
    plot.curves.push_back(measured);
  }
  finding.plots.emplace_back("viscosity", plot);
  return finding;
}

Finding verify_energy_balance(const VerificationSettings& settings)
{
  Finding finding;
  for (const std::string kind : { "undamped", "damped", "viscous" })
  {
    Model model = hanging_bar({ { 12, 4, 4 } }, 9.81);
    add_muscle(model, Muscle{ "bar", 20e3, true, true },
               [](std::size_t) {
                 return std::array<float, 3>{ { 1, 0, 0 } };
               });
    if (kind == "damped")
      model.damping = 40;
    if (kind == "viscous")
    {
      model.materials[0].viscous_share = { { 0.3, 0.2 } };
      model.materials[0].viscous_time = { { 0.005, 0.05 } };
    }
    SolverSettings with_ledger{ settings.backend, 1, 0 };
    with_ledger.ledger = true;
    const auto solver = make_solver(std::make_shared<const Model>(model), with_ledger);
    Controls target = solver->controls();
    target.activation[0] = 0.5F;
    solver->advance(0.05, target);
    solver->advance(0.1, target);
    const EnergyLedger ledger = solver->ledger();
    finding.checks.absolute("unexplained, " + kind + " bar", "%", 0,
                            100 * std::abs(ledger.imbalance()) / ledger.largest, 1);
  }
  return finding;
}

Finding verify_precision(const VerificationSettings&)
{
  Finding finding;
  constexpr int steps = 1000000;
  const auto end_displacement = [&](const Backend& backend, Precision precision)
  {
    Model model = hanging_bar({ { 16, 1, 1 } }, 0);
    model.precision = precision;
    model.damping = 200;
    Load load;
    load.name = "push";
    load.value = { { 0, 0, -6 } };
    for (const double y : { 0.0, 1e-3 })
      for (const double z : { 0.0, 1e-3 })
      {
        load.mesh.vertices.push_back({ { 16e-3, y, z } });
        load.binding.voxel.push_back(15);
        load.binding.coordinates.push_back({ { 1, y > 0 ? 1.0F : 0.0F, z > 0 ? 1.0F : 0.0F } });
      }
    load.mesh.triangles = { { { 0, 2, 3 } }, { { 0, 3, 1 } } };
    constexpr double time_step = 5e-6;
    load.ramp = steps * time_step;
    model.loads.push_back(load);
    const auto end = nodes_where(model, [](const auto& p) { return p[0] > 15.5e-3; });
    const auto solver = make_solver(std::make_shared<const Model>(model), { backend, 1, time_step });
    solver->advance(load.ramp, solver->controls());
    Vectors u;
    solver->displacements(u);
    return mean_displacement(u, end)[2];
  };
  const double expected = 1e3 * end_displacement("reference", Precision::double_precision);
  struct Way
  {
    const char* name;
    Precision precision;
    double bound;
  };
  for (const auto& way : { Way{ "single", Precision::single, 1e-3 }, Way{ "compensated", Precision::compensated, 1e-3 },
                           Way{ "double", Precision::double_precision, 1e-7 } })
    finding.checks.relative(std::string(way.name) + ", end's displacement", "mm", expected,
                            1e3 * end_displacement("cpu", way.precision), way.bound);
  return finding;
}

}  // namespace frontalis
