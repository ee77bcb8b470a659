#include "backends.hpp"
#include "block_model.hpp"

#include "frontalis/error.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace frontalis
{
namespace
{

using Vectors = std::vector<std::array<double, 3>>;

Model bar(double damping, HourglassControl hourglass = HourglassControl::scalar,
          Integration integration = Integration::one_point)
{
  test::BlockSettings settings;
  settings.voxels = { { 8, 3, 3 } };
  settings.damping = damping;
  Model model = test::block_model(settings);
  model.hourglass = hourglass;
  model.integration = integration;
  test::hold_plane(model, 0);
  return model;
}

class Ledger : public test::EveryBackend
{
protected:
  std::unique_ptr<Solver> accounting(const Model& model) const
  {
    return make_solver(std::make_shared<const Model>(model), { GetParam(), 0, 0, true });
  }
  // Plays a motion in slices and checks the balance after each slice.
  static EnergyLedger play(Solver& solver, const Controls& target, double seconds, int slices)
  {
    EnergyLedger ledger;
    for (int i = 0; i < slices; ++i)
    {
      solver.advance(seconds / slices, target);
      ledger = solver.ledger();
      EXPECT_LT(std::abs(ledger.imbalance()), 0.01 * ledger.largest) << "slice " << i;
    }
    return ledger;
  }
};

TEST_P(Ledger, closes_for_a_bar_that_falls_and_swings)
{
  for (const auto integration : { Integration::one_point, Integration::selective_reduced })
    for (const auto form : { HourglassControl::scalar, HourglassControl::assumed_strain })
      for (const double damping : { 0.0, 40.0 })
      {
        Model model = bar(damping, form, integration);
        model.gravity = { { 0, 0, -9.81 } };
        const auto solver = accounting(model);
        const EnergyLedger ledger = play(*solver, {}, 0.1, 5);
        EXPECT_GT(ledger["gravity"], 0);
        EXPECT_EQ(ledger["damping"] > 0, damping > 0);
      }
}

// Above 1.8 / time step, damping leaves a nineteenth of each velocity.
TEST_P(Ledger, closes_with_damping_above_its_limit)
{
  Model model = bar(3e5);
  model.gravity = { { 0, 0, -9.81 } };
  const auto solver = accounting(model);
  const EnergyLedger ledger = play(*solver, {}, 0.02, 2);
  EXPECT_GT(0.5 * model.damping * solver->time_step(), 1.5);
  EXPECT_GT(ledger["damping"], 0.5 * ledger["gravity"]);
}

TEST_P(Ledger, closes_for_a_muscle_that_shortens_and_lets_go)
{
  Model model = bar(100);
  Muscle muscle;
  muscle.name = "strand";
  muscle.stress_reference = 20e3;
  muscle.passive = true;
  test::add_muscle(model, { { 1, 0, 0 } }, muscle);
  const auto solver = accounting(model);
  const EnergyLedger pulled = play(*solver, { { 0.8f }, {} }, 0.05, 4);
  EXPECT_GT(pulled["muscle"], 0);
  const EnergyLedger back = play(*solver, { { 0 }, {} }, 0.1, 4);
  EXPECT_LT(back["internal"], 0.2 * pulled["internal"]);
}

// A random distortion excites the highest frequencies of the mesh; the time step is small enough to resolve them.
TEST_P(Ledger, closes_after_a_random_distortion)
{
  Model model = bar(20);
  model.time_step_share = 0.3;
  const auto solver = accounting(model);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> value(-0.2e-3, 0.2e-3);
  Vectors u(model.nodes.size());
  for (std::size_t n = 0; n < u.size(); ++n)
    if (model.nodes[n][0] != 0)
      for (double& x : u[n])
        x = value(random);
  solver->set_displacements(u);
  EXPECT_GT(solver->ledger().initial, 0);
  play(*solver, {}, 0.05, 10);
}

TEST_P(Ledger, closes_for_an_end_that_is_pulled_and_a_side_that_is_pressed)
{
  Model model = bar(50);
  Load pull;
  pull.name = "pull";
  pull.kind = Load::Kind::displacement;
  pull.value = { { 2e-3, 0, 0 } };
  pull.ramp = 0.02;
  model.loads.push_back(pull);
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    if (model.nodes[n][0] == model.size[0])
      model.prescribed.push_back({ static_cast<std::int32_t>(n), 0 });
  Load press;
  press.name = "press";
  press.kind = Load::Kind::traction;
  press.value = { { 0, 0, -300 } };
  press.ramp = 0.02;
  press.mesh.vertices = { { { 3e-3, 0, 3e-3 } }, { { 5e-3, 0, 3e-3 } }, { { 4e-3, 3e-3, 3e-3 } } };
  press.mesh.triangles = { { { 0, 1, 2 } } };
  for (const auto& corner : { std::array<std::int32_t, 2>{ { 3, 0 } }, { { 5, 0 } }, { { 4, 2 } } })
  {
    press.binding.voxel.push_back(corner[0] + model.size[0] * (corner[1] + model.size[1] * (model.size[2] - 1)));
    press.binding.coordinates.push_back({ { 0, corner[1] > 0 ? 1.0f : 0.0f, 1 } });
  }
  model.loads.push_back(press);
  const auto solver = accounting(model);
  const EnergyLedger ledger = play(*solver, {}, 0.05, 5);
  EXPECT_GT(ledger["constraint"], 0);
  EXPECT_GT(ledger["damping"], 0);
  EXPECT_GT(ledger["load"], 0);
}

// Velocities belong to the middle of each step. When the length of steps changes, the first change of the velocities
// covers the mean of both lengths.
TEST_P(Ledger, closes_where_the_time_step_changes)
{
  Model model = bar(0);
  model.gravity = { { 2000, 0, 0 } };
  const auto solver = accounting(model);
  for (int i = 0; i < 60; ++i)
  {
    solver->slow_down(i % 2 == 0 ? 1 : 0.4);
    solver->advance((20 + i * 7 % 13) * solver->time_step(), {});
    const EnergyLedger ledger = solver->ledger();
    EXPECT_LT(std::abs(ledger.imbalance()), 1e-3 * ledger.largest) << "slice " << i;
  }
}

TEST_P(Ledger, is_refused_where_it_was_not_asked_for)
{
  const auto without = solver(bar(0));
  EXPECT_THROW(without->ledger(), Error);
}

FRONTALIS_EVERY_BACKEND(Ledger);

// The motion is bitwise the same with and without a ledger, and the ledger is bitwise the same on any number of
// threads.
TEST(LedgerOnCpu, leaves_the_motion_alone_and_does_not_depend_on_threads)
{
  Model model = bar(20);
  model.gravity = { { 0, 0, -9.81 } };
  const auto shared = std::make_shared<const Model>(model);
  Vectors reference, moved;
  const auto plain = make_solver(shared, { "cpu", 1, 0 });
  plain->advance(0.02, {});
  plain->displacements(reference);
  double damping = -1;
  for (const int threads : { 1, 2, 4 })
  {
    const auto solver = make_solver(shared, { "cpu", threads, 0, true });
    solver->advance(0.02, {});
    solver->displacements(moved);
    EXPECT_EQ(reference, moved) << threads;
    const double now = solver->ledger()["damping"];
    EXPECT_EQ(now, damping < 0 ? now : damping);
    damping = now;
  }
}

}  // namespace
}  // namespace frontalis
