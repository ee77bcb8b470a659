// Time dependence: viscous relaxation, the balance of energies, a million steps in single precision.

#include "study/verification/verification_cases.hpp"

#include <cmath>
#include <tuple>

namespace frontalis
{
namespace
{

// Shear force on the upper side of a block [N].
double shear_force(Solver& solver, const Model& model)
{
  return internal_force(
      solver, nodes_where(model, [&](const auto& p) { return p[1] > (model.size[1] - 0.5) * model.spacing[1]; }))[0];
}

Model sheared_block(const std::array<double, 2>& share, const std::array<double, 2>& time)
{
  Material material = neo_hookean(34e3, 0.49);
  material.viscous_share = share;
  material.viscous_time = time;
  Model model = voxel_model({ { 3, 2, 2 } }, 1e-3, material);
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    prescribe(model, { static_cast<std::int32_t>(n) }, { { true, true, true } },
              { { 0.1 * rest_position(model, n)[1], 0, 0 } });
  return model;
}

// A bar along x under gravity [m/s2], fixed at one end.
Model hanging_bar(const Voxel& size, double gravity)
{
  Model model = voxel_model(size, 1e-3, neo_hookean(34e3, 0.45));
  hold(model, [](const auto& p) { return p[0] == 0; });
  model.gravity = { { gravity, 0, -0.3 * gravity } };
  return model;
}

}  // namespace

void verify_viscosity(const Backend& backend, Finding& finding)
{
  Plot plot{ "Stress of a sheared block that is held", "time [s]", "stress over the elastic one [1]" };
  plot.x_log = true;
  plot.key = "bottom left";
  struct Series
  {
    std::string name;
    std::array<double, 2> share, time;
  };
  for (const auto& series : { Series{ "one term", { { 0.4, 0 } }, { { 0.02, 0 } } },
                              Series{ "two terms", { { 0.3, 0.2 } }, { { 0.01, 0.1 } } } })
  {
    const Model model = sheared_block(series.share, series.time);
    const auto elastic = solver_of(sheared_block({}, {}), backend), viscous = solver_of(model, backend);
    elastic->advance(1e-4, elastic->controls());
    const double at_once = shear_force(*elastic, model);
    Plot::Curve theory{ series.name + ", closed form", {}, {}, Plot::Style::line };
    Plot::Curve measured{ series.name + ", solver", {}, {}, Plot::Style::points };
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
      measured.add(now, shear_force(*viscous, model) / at_once);
      finding.checks.relative(series.name + ", after " + readable(now) + " s", "1", left(now), measured.y.back(), 5e-5);
    }
    plot.curves.insert(plot.curves.end(), { theory, measured });
  }
  finding.plots.emplace_back("viscosity", plot);
}

void verify_energy_balance(const Backend& backend, Finding& finding)
{
  for (const std::string kind : { "undamped", "damped", "viscous" })
  {
    Model model = hanging_bar({ { 12, 4, 4 } }, 9.81);
    add_muscle(model, Muscle{ "bar", 20e3, true, true }, along_x);
    if (kind == "damped")
      model.damping = 40;
    if (kind == "viscous")
    {
      model.materials[0].viscous_share = { { 0.3, 0.2 } };
      model.materials[0].viscous_time = { { 0.005, 0.05 } };
    }
    SolverSettings with_ledger{ backend, 1, 0 };
    with_ledger.ledger = true;
    const auto solver = make_solver(std::make_shared<const Model>(model), with_ledger);
    Controls target = solver->controls();
    target.activation[0] = 0.5F;
    solver->advance(0.05, target);
    solver->advance(0.1, target);
    const EnergyLedger ledger = solver->ledger();
    finding.checks.absolute("unexplained, " + kind + " bar", "%", 0,
                            100 * std::abs(ledger.imbalance()) / ledger.largest, 5e-4);
  }
}

void verify_precision(const Backend&, Finding& finding)
{
  constexpr int steps = 1000000;
  // Displacement of the bar's end [mm] under a pressure that has grown during all steps.
  const auto end_displacement = [&](const Backend& backend, Precision precision)
  {
    Model model = hanging_bar({ { 16, 1, 1 } }, 0);
    model.precision = precision;
    model.damping = 200;
    Load load;
    load.name = "push";
    load.value = { { 0, 0, -6 } };
    load.mesh.vertices = {
      { { 16e-3, 0, 0 } }, { { 16e-3, 0, 1e-3 } }, { { 16e-3, 1e-3, 0 } }, { { 16e-3, 1e-3, 1e-3 } }
    };
    load.mesh.triangles = { { { 0, 2, 3 } }, { { 0, 3, 1 } } };
    load.binding = bind_points(model, load.mesh.vertices);
    constexpr double time_step = 5e-6;
    load.ramp = steps * time_step;
    model.loads.push_back(load);
    const auto end = nodes_where(model, [](const auto& p) { return p[0] > 15.5e-3; });
    const auto solver = make_solver(std::make_shared<const Model>(model), { backend, 1, time_step });
    solver->advance(load.ramp, solver->controls());
    Vectors u;
    solver->displacements(u);
    return 1e3 * mean_displacement(u, end)[2];
  };
  const double expected = end_displacement("reference", Precision::double_precision);
  for (const auto& [name, precision, bound] :
       { std::tuple("single", Precision::single, 1e-3), std::tuple("compensated", Precision::compensated, 1e-3),
         std::tuple("double", Precision::double_precision, 1e-7) })
    finding.checks.relative(std::string(name) + ", end's displacement", "mm", expected,
                            end_displacement("cpu", precision), bound);
}

}  // namespace frontalis
