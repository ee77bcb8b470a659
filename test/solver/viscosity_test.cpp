#include "backends.hpp"
#include "block_model.hpp"

#include <cmath>

namespace frontalis
{
namespace
{

using Vectors = std::vector<std::array<double, 3>>;

// A block with all nodes held, to find the stress at a constant strain.
Model held_block(const std::array<double, 2>& share, const std::array<double, 2>& time)
{
  test::BlockSettings settings;
  settings.voxels = { { 3, 2, 2 } };
  Model model = test::block_model(settings);
  model.materials[0].viscous_share = share;
  model.materials[0].viscous_time = time;
  Load stretch;
  stretch.name = "held";
  stretch.kind = Load::Kind::displacement;
  model.loads.push_back(stretch);
  return model;
}

// A block whose nodes are displaced at once to simple shear, which causes only isochoric stress.
Model sheared_block(double shear, const std::array<double, 2>& share, const std::array<double, 2>& time)
{
  Model model = held_block(share, time);
  model.loads.clear();
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
  {
    Load load;
    load.name = "node " + std::to_string(n);
    load.kind = Load::Kind::displacement;
    load.value = { { shear * test::rest(model, n)[1], 0, 0 } };
    model.prescribed.push_back({ static_cast<std::int32_t>(n), static_cast<std::int32_t>(model.loads.size()) });
    model.loads.push_back(load);
  }
  return model;
}

double shear_force(Solver& solver, const Model& model)
{
  Vectors f;
  solver.internal_forces(f);
  double sum = 0;
  for (std::size_t n = 0; n < f.size(); ++n)
    if (model.nodes[n][1] == model.size[1])
      sum += f[n][0];
  return sum;
}

class Viscosity : public test::EveryBackend
{
};

TEST_P(Viscosity, stress_relaxes_as_the_prony_series_says)
{
  const std::array<double, 2> share{ { 0.3, 0.2 } }, time{ { 0.01, 0.05 } };
  const double gamma = 0.1;
  const Model model = sheared_block(gamma, share, time);
  const auto viscous = solver(model);
  const auto elastic = solver(sheared_block(gamma, {}, {}));
  const Controls none;
  elastic->advance(1e-4, none);
  const double instantaneous = shear_force(*elastic, model);
  double now = 0;
  for (const double then : { 0.002, 0.01, 0.03, 0.1, 0.3 })
  {
    viscous->advance(then - now, none);
    now = then;
    const double left = 1 - share[0] * (1 - std::exp(-now / time[0])) - share[1] * (1 - std::exp(-now / time[1]));
    EXPECT_NEAR(shear_force(*viscous, model) / instantaneous, left, 3e-3) << "after " << now << " s";
  }
}

TEST_P(Viscosity, energy_that_a_swinging_block_loses_is_accounted_for)
{
  test::BlockSettings settings;
  settings.voxels = { { 6, 3, 3 } };
  Model model = test::block_model(settings);
  test::hold_plane(model, 0);
  model.materials[0].viscous_share = { { 0.4, 0 } };
  model.materials[0].viscous_time = { { 2e-3, 0 } };
  const auto swinging = make_solver(std::make_shared<const Model>(model), { GetParam(), 0, 0, true });
  Vectors v(model.nodes.size());
  for (std::size_t n = 0; n < v.size(); ++n)
    v[n] = { { 0, 0, 50 * test::rest(model, n)[0] } };
  swinging->set_velocities(v);
  const double initial = swinging->ledger().initial;
  swinging->advance(0.05, {});
  const EnergyLedger ledger = swinging->ledger();
  EXPECT_GT(ledger["viscous"], 0.5 * initial) << "much of the motion is lost";
  EXPECT_LT(std::abs(ledger.imbalance()), 0.01 * ledger.largest);
}

// The work of relaxation must be that at the middle of a step. At the end of the step, its error would be dt / (2 *
// time constant).
TEST_P(Viscosity, energy_is_accounted_for_where_stresses_relax_within_some_steps)
{
  test::BlockSettings settings;
  settings.voxels = { { 4, 2, 2 } };
  Model model = test::block_model(settings);
  test::hold_plane(model, 0);
  model.materials[0].viscous_share = { { 0.5, 0.2 } };
  model.materials[0].viscous_time = { { 4e-4, 4e-3 } };
  const auto swinging = make_solver(std::make_shared<const Model>(model), { GetParam(), 0, 0, true });
  ASSERT_GT(swinging->time_step(), 4e-4 / 40);
  Vectors v(model.nodes.size());
  for (std::size_t n = 0; n < v.size(); ++n)
    v[n] = { { 0, 0, 50 * test::rest(model, n)[0] } };
  swinging->set_velocities(v);
  swinging->advance(0.02, {});
  const EnergyLedger ledger = swinging->ledger();
  EXPECT_GT(ledger["viscous"], 0.5 * ledger.initial);
  EXPECT_LT(std::abs(ledger.imbalance()), 2e-3 * ledger.largest);
}

TEST_P(Viscosity, stress_stays_where_there_is_none)
{
  const Model model = sheared_block(0.05, {}, {});
  const auto elastic = solver(model);
  elastic->advance(1e-3, {});
  const double begin = shear_force(*elastic, model);
  elastic->advance(0.1, {});
  EXPECT_NEAR(shear_force(*elastic, model) / begin, 1, 1e-6);
}

FRONTALIS_EVERY_BACKEND(Viscosity);

}  // namespace
}  // namespace frontalis
