#include "backends.hpp"
#include "effect_scene.hpp"
#include "wrapped_solver.hpp"

#include "frontalis/error.hpp"
#include "frontalis/solver/guard.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace frontalis
{
namespace
{

using Vectors = std::vector<std::array<double, 3>>;

class Guarded : public test::EveryBackend
{
protected:
  static GuardSettings close() { return { 64, 0.5, 2 }; }
  static Controls full(const Solver& solver, float activation)
  {
    Controls controls = solver.controls();
    std::fill(controls.activation.begin(), controls.activation.end(), activation);
    return controls;
  }
  static Vectors displacements(const Solver& solver)
  {
    Vectors u;
    solver.displacements(u);
    return u;
  }
};

double farthest(const Vectors& a, const Vectors& b)
{
  double worst = 0;
  for (std::size_t n = 0; n < a.size(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      worst = std::max(worst, std::abs(a[n][axis] - b[n][axis]));
  return worst;
}

// Two planes of nodes are driven through each other, which no time step can handle.
Model crushed()
{
  test::BlockSettings settings;
  settings.voxels = { { 1, 2, 2 } };
  settings.damping = 200;
  Model model = test::block_model(settings);
  model.to_scene.translation = { { 0.1, 0, 0 } };
  Load press;
  press.name = "press";
  press.kind = Load::Kind::displacement;
  press.value = { { -1.5e-3, 0, 0 } };
  press.ramp = 0.02;
  model.loads.push_back(press);
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
  {
    if (model.nodes[n][0] == 0)
      model.rigid.push_back({ static_cast<std::int32_t>(n), -1 });
    if (model.nodes[n][0] == 1)
      model.prescribed.push_back({ static_cast<std::int32_t>(n), 0 });
  }
  return model;
}

TEST_P(Guarded, sound_motion_is_left_alone)
{
  for (const bool ledger : { false, true })
  {
    const auto model = std::make_shared<const Model>(test::scene_of(test::but_friction));
    const auto solver = make_solver(model, { GetParam(), 2, 0, ledger });
    GuardSettings settings = close();
    settings.ledger = ledger;
    Guard guard(*solver, model, settings);
    for (const float activation : { 1.0f, 0.0f, 0.7f })
      guard.advance(3e-3, full(*solver, activation));
    EXPECT_DOUBLE_EQ(solver->time(), 9e-3);
    EXPECT_GT(guard.counts().checks, 4);
    EXPECT_EQ(guard.counts().rollbacks, 0) << words_for(guard.counts().latest);
    EXPECT_TRUE(guard.latest().finite);
  }
}

TEST_P(Guarded, motion_goes_on_where_it_was_disturbed)
{
  const auto model = std::make_shared<const Model>(test::scene_of(test::contraction));
  const auto undisturbed = make_solver(model, { GetParam(), 2 });
  for (int part = 0; part < 3; ++part)
    undisturbed->advance(4e-3, full(*undisturbed, 0.7f));
  const Vectors expected = displacements(*undisturbed);

  using Disturb = std::function<void(Solver&)>;
  const auto all = [&](double x) { return Vectors(model->nodes.size(), { { x, -x, x } }); };
  Vectors inside_out(model->nodes.size());
  for (std::size_t n = 0; n < inside_out.size(); ++n)
    inside_out[n][0] = -2 * test::rest(*model, n)[0];
  const std::pair<Instability, Disturb> disturbances[] = {
    { Instability::not_finite, [&](Solver& s) { s.set_velocities(all(std::nan(""))); } },
    { Instability::not_finite, [&](Solver& s) { s.set_displacements(all(std::numeric_limits<double>::infinity())); } },
    { Instability::energy, [&](Solver& s) { s.set_velocities(all(20)); } },
    { Instability::inverted, [&](Solver& s) { s.set_displacements(inside_out); } },
  };
  for (const auto& [kind, disturb] : disturbances)
  {
    const auto solver = make_solver(model, { GetParam(), 2 });
    Guard guard(*solver, model, close());
    guard.advance(4e-3, full(*solver, 0.7f));
    guard.advance(4e-3, full(*solver, 0.7f));
    disturb(*solver);
    guard.advance(4e-3, full(*solver, 0.7f));
    EXPECT_EQ(guard.counts().rollbacks, 1) << words_for(kind);
    EXPECT_EQ(guard.counts().latest, kind) << words_for(guard.counts().latest);
    EXPECT_DOUBLE_EQ(solver->time(), 12e-3);
    EXPECT_LT(farthest(displacements(*solver), expected), 2e-6) << words_for(kind);
    // The full time step returns after a while without disturbances.
    guard.advance(4e-3, full(*solver, 0.7f));
    EXPECT_NEAR(solver->time_step(), undisturbed->time_step(), 0.1 * undisturbed->time_step());
  }
}

TEST_P(Guarded, a_bone_that_has_come_back_when_it_is_checked_has_brought_energy_too)
{
  Model still = test::block_model({});
  still.bones = { "grip" };
  test::hold_plane(still, 0, 0);
  const auto model = std::make_shared<const Model>(still);
  const auto solver = make_solver(model, { GetParam(), 2 });
  Guard guard(*solver, model, { 1000 });
  Controls there = solver->controls();
  there.bone[0].translation = { { 0.5 * model->spacing[0], 0, 0.5 * model->spacing[2] } };
  const double part = 60 * solver->time_step();
  guard.advance(part, there);
  guard.advance(part, Controls{ {}, { RigidTransform() } });
  guard.advance(20 * part, Controls{ {}, { RigidTransform() } });
  EXPECT_GT(guard.counts().checks, 0);
  EXPECT_EQ(guard.counts().rollbacks, 0) << words_for(guard.counts().latest);
}

TEST_P(Guarded, settling_goes_on_where_it_was_disturbed)
{
  const auto model = std::make_shared<const Model>(test::scene_of(test::contraction));
  const auto undisturbed = make_solver(model, { GetParam(), 2 });
  ASSERT_TRUE(undisturbed->settle(full(*undisturbed, 0.7f), 1e-4, 5).reached);
  const auto solver = make_solver(model, { GetParam(), 2 });
  Guard guard(*solver, model, close());
  int windows = 0;
  const Equilibrium found =
      guard.settle(full(*solver, 0.7f), 1e-4, 5,
                   [&](const Equilibrium&)
                   {
                     if (++windows == 5)
                       solver->set_velocities(Vectors(model->nodes.size(), { { std::nan(""), 0, 0 } }));
                     return true;
                   });
  EXPECT_TRUE(found.reached);
  EXPECT_EQ(guard.counts().rollbacks, 1);
  EXPECT_EQ(guard.counts().latest, Instability::not_finite);
  EXPECT_LT(farthest(displacements(*solver), displacements(*undisturbed)), 2e-6);
}

TEST_P(Guarded, a_motion_that_no_time_step_helps_is_stopped_and_explained)
{
  const auto model = std::make_shared<const Model>(crushed());
  const auto solver = make_solver(model, { GetParam(), 2 });
  GuardSettings settings = close();
  settings.inverted_share = 0;
  Guard guard(*solver, model, settings);
  try
  {
    guard.advance(0.02, solver->controls());
    FAIL() << "voxels were turned inside out";
  }
  catch (const Unstable& stopped)
  {
    const InstabilityReport& r = stopped.report;
    EXPECT_EQ(r.kind, Instability::inverted);
    EXPECT_LE(r.jacobian, 0);
    ASSERT_GE(r.voxel, 0);
    EXPECT_NEAR(r.scene[0], 0.1 + (model->voxels[r.voxel][0] + 0.5) * 1e-3, 1e-12);
    EXPECT_EQ(r.material, std::vector<std::string>{ "tissue" });
    EXPECT_TRUE(r.muscle.empty());
    const std::string text = stopped.what();
    for (const char* part : { "turn inside out", "voxel", "mm in the scene", "tissue", "fault", "press" })
      EXPECT_NE(text.find(part), std::string::npos) << part << " in: " << text;
  }
  EXPECT_GE(guard.counts().rollbacks, settings.tries);
  // The last good state was restored, and the solver can continue from it.
  EXPECT_TRUE(solver->monitor().finite);
  EXPECT_EQ(solver->monitor().inverted, 0);
  EXPECT_LT(solver->time(), 0.02);
  SkinState skin;
  solver->skin(skin);
  EXPECT_THROW(guard.advance(0.02, solver->controls()), Unstable);
  solver->reset();
  guard.restart();
  guard.advance(1e-3, solver->controls());
  EXPECT_DOUBLE_EQ(solver->time(), 1e-3);
}

TEST_P(Guarded, bad_input_changes_nothing)
{
  const auto model = std::make_shared<const Model>(test::scene_of(test::contraction));
  const auto solver = make_solver(model, { GetParam(), 2 });
  Guard guard(*solver, model, close());
  guard.advance(1e-3, full(*solver, 0.5f));
  const Vectors before = displacements(*solver);
  for (const float bad : { -0.1f, 1.1f, std::nanf("") })
    EXPECT_THROW(guard.advance(1e-2, full(*solver, bad)), Error);
  EXPECT_THROW(guard.advance(1e-2, {}), Error);
  EXPECT_THROW(guard.advance(std::nan(""), solver->controls()), Error);
  EXPECT_EQ(displacements(*solver), before);
  for (const GuardSettings& bad : { GuardSettings{ -1 }, GuardSettings{ 64, 1.0 }, GuardSettings{ 64, 0.5, 0 },
                                    GuardSettings{ 64, 0.5, 4, -1 }, GuardSettings{ 64, 0.5, 4, 3, 1.5 } })
    EXPECT_THROW(Guard(*solver, model, bad), Error);
}

/// A solver that reports altered values from the time `from` on, until the guard has restored a snapshot `times` times.
struct ShownOtherwise : test::WrappedSolver
{
  using WrappedSolver::WrappedSolver;
  std::function<void(Monitor&)> change;
  double more_work = 0;  // work that the ledger does not explain [J]
  double from = 1;       // [s]
  int times = 1, restored = 0;

  bool now() { return WrappedSolver::time() > from && restored < times; }
  void restore(const Snapshot& snapshot) override
  {
    ++restored;
    WrappedSolver::restore(snapshot);
  }
  Monitor monitor() override
  {
    Monitor result = WrappedSolver::monitor();
    if (change && now())
      change(result);
    return result;
  }
  EnergyLedger ledger() override
  {
    EnergyLedger result = WrappedSolver::ledger();
    if (now())
      result["kinetic"] += more_work;
    return result;
  }
};

TEST_P(Guarded, finds_hourglass_energy_too_long_steps_and_an_unbalanced_ledger)
{
  const auto model = std::make_shared<const Model>(test::scene_of(test::contraction));
  const std::pair<Instability, std::function<void(ShownOtherwise&)>> cases[] = {
    { Instability::hourglass, [](ShownOtherwise& s) { s.change = [](Monitor& m) { m.hourglass += 1; }; } },
    { Instability::time_step, [](ShownOtherwise& s) { s.change = [](Monitor& m) { m.step_share = 1.2; }; } },
    { Instability::energy, [](ShownOtherwise& s) { s.more_work = s.ledger().largest; } },
  };
  for (const auto& [kind, show] : cases)
  {
    ShownOtherwise solver(make_solver(model, { GetParam(), 2, 0, true }));
    GuardSettings settings = close();
    settings.ledger = true;
    Guard guard(solver, model, settings);
    guard.advance(4e-3, full(solver, 0.7f));
    EXPECT_EQ(guard.counts().rollbacks, 0);
    show(solver);
    solver.from = 4e-3;
    guard.advance(4e-3, full(solver, 0.7f));
    EXPECT_EQ(guard.counts().rollbacks, 1) << words_for(kind);
    EXPECT_EQ(guard.counts().latest, kind) << words_for(guard.counts().latest);
    EXPECT_DOUBLE_EQ(solver.time(), 8e-3);
  }
}

// The guard repeats the motion before the failure with the controls of that time, not with later ones.
TEST_P(Guarded, looks_for_the_fault_on_the_way_that_was_gone)
{
  struct Watched : ShownOtherwise
  {
    using ShownOtherwise::ShownOtherwise;
    double begin = 0, most_ahead = 0;
    bool advance(double seconds, const Controls& target, const std::function<bool()>& go_on) override
    {
      const double due = (WrappedSolver::time() + seconds - begin) / 0.1;
      most_ahead = std::max(most_ahead, double(target.activation[0]) - due);
      return ShownOtherwise::advance(seconds, target, go_on);
    }
  };
  const auto model = std::make_shared<const Model>(test::scene_of(test::contraction));
  Watched solver(make_solver(model, { GetParam(), 2 }));
  solver.from = 2e-3;
  solver.times = 100;
  solver.change = [](Monitor& m) { m.finite = false; };
  Guard guard(solver, model, close());
  EXPECT_THROW(guard.advance(0.1, full(solver, 1)), Unstable);
  EXPECT_LT(solver.most_ahead, 1e-6);
  EXPECT_GT(solver.restored, 4);
}

TEST_P(Guarded, a_motion_ends_at_once_in_a_good_state_where_it_is_told_to)
{
  const auto model = std::make_shared<const Model>(crushed());
  const auto solver = make_solver(model, { GetParam(), 2 });
  GuardSettings settings = close();
  settings.inverted_share = 0;
  Guard guard(*solver, model, settings);
  bool ended = true;
  int most = 0;
  for (; ended; most = most + 1 + most / 8)
  {
    solver->reset();
    guard.restart();
    int calls = 0;
    try
    {
      ended = !guard.advance(0.02, solver->controls(), [&] { return ++calls <= most; });
      ASSERT_TRUE(ended) << "voxels were turned inside out";
      ASSERT_EQ(calls, most + 1);
      ASSERT_TRUE(solver->monitor().finite);
      ASSERT_EQ(solver->monitor().inverted, 0);
    }
    catch (const Unstable&)
    {
      ended = false;
    }
  }
  EXPECT_GT(most, 20);
  solver->reset();
  guard.restart();
  EXPECT_TRUE(guard.advance(1e-3, solver->controls(), [] { return true; }));
  EXPECT_DOUBLE_EQ(solver->time(), 1e-3);
}

// Four tries and the search begin with a restored snapshot; in the search steps are longer than they seem to be.
TEST_P(Guarded, the_search_for_the_fault_is_short_and_ends_where_it_is_told_to)
{
  struct Counted : ShownOtherwise
  {
    using ShownOtherwise::ShownOtherwise;
    std::int64_t steps_before = 0;
    void restore(const Snapshot& snapshot) override
    {
      if (restored < 4)
        steps_before = profile().steps;
      ShownOtherwise::restore(snapshot);
    }
    double time_step() const override { return (restored == 4 ? 1000 : 1) * ShownOtherwise::time_step(); }
    bool searches() const { return restored >= 4; }
  };
  const auto model = std::make_shared<const Model>(test::scene_of(test::contraction));
  for (const bool ends : { false, true })
  {
    Counted solver(make_solver(model, { GetParam(), 2 }));
    solver.from = 2e-3;
    solver.times = 4;
    solver.change = [](Monitor& m) { m.finite = false; };
    GuardSettings settings = close();
    settings.recovery = 1000;
    Guard guard(solver, model, settings);
    const auto go_on = [&] { return !ends || !solver.searches(); };
    if (ends)
      EXPECT_FALSE(guard.advance(0.1, full(solver, 1), go_on));
    else
      EXPECT_THROW(guard.advance(0.1, full(solver, 1), go_on), Unstable);
    EXPECT_EQ(solver.restored, 5);
    EXPECT_LE(solver.profile().steps - solver.steps_before, ends ? 0 : 6 * settings.interval);
    EXPECT_LE(solver.time(), 2e-3);
  }
}

FRONTALIS_EVERY_BACKEND(Guarded);

}  // namespace
}  // namespace frontalis
