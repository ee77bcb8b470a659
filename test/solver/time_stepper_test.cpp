#include "solver/stepping/time_stepper.hpp"

#include "block_model.hpp"
#include "frontalis/solver/rigid_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace frontalis;

namespace
{

/// Calls of a scripted backend, and the answers that it gives.
struct Script
{
  std::vector<StepPlan> plans;
  std::vector<EffectSet> running;
  std::vector<double> damping;  // damping of each plan
  double bound = 0;             // bound of the squared frequency [1/s2]
  double velocity = 0;          // velocity of all nodes along z [m/s]
  Work work;
  double found = 0;        // what a search finds [1/s2]; 0: the bound
  bool mass_helps = true;  // whether further searches find less
  int searches = 0;
  std::vector<std::pair<double, bool>> growth;  // arguments of measure_growth()
  std::vector<std::int32_t> changed;            // nodes of the latest change of masses
};

struct ScriptState : BackendState
{
  std::size_t plans = 0;
  void archive(ByteArchive& archive) override { archive(plans); }
};

/// A backend that does not move anything and records its calls.
class ScriptedBackend : public StepBackend
{
public:
  ScriptedBackend(const BackendInput& input, Script& script) : StepBackend(input), script_(script)
  {
    script_.bound = discretisation_.frequency_squared_max;
  }
  BackendTraits traits() const override
  {
    BackendTraits traits;
    traits.description = "scripted";
    return traits;
  }
  void list_arrays(ArrayList& list) override { list.add(Effect::elasticity, "script", 3); }
  PlanMeasures run(const StepPlan& plan) override
  {
    script_.plans.push_back(plan);
    script_.damping.push_back(conditions_.damping);
    return { script_.bound, script_.velocity };
  }
  void effects_switched() override { script_.running.push_back(conditions_.running); }
  void get(NodalField field, NodalVectors& out) const override
  {
    out.assign(model_->nodes.size(), { { 0, 0, field == NodalField::velocities ? script_.velocity : 0 } });
  }
  void set(NodalField, const NodalVectors& in) override { script_.velocity = in.empty() ? 0 : in[0][2]; }
  void save(std::unique_ptr<BackendState>& to) override
  {
    auto state = std::make_unique<ScriptState>();
    state->plans = script_.plans.size();
    to = std::move(state);
  }
  void restore(const BackendState& from) override { script_.plans.resize(static_cast<const ScriptState&>(from).plans); }
  void internal_forces(NodalVectors& out) override { out.assign(model_->nodes.size(), {}); }
  double highest_frequency_squared() override
  {
    // mass that was added lowers the frequency
    ++script_.searches;
    return (script_.found > 0 ? script_.found : script_.bound) / (script_.mass_helps ? script_.searches : 1);
  }
  void measure_growth(double found, bool keeps) override { script_.growth.emplace_back(found, keeps); }
  std::vector<FoundMode> modes_above(double) override { return { { script_.found, { { 5, 0.01F } } } }; }
  void masses_changed(const std::vector<std::int32_t>& nodes) override { script_.changed = nodes; }
  Monitor monitor() override
  {
    Monitor monitor;
    monitor.critical_time_step = 2 / std::sqrt(script_.bound);
    monitor.internal = 3;
    monitor.hourglass = 2;
    return monitor;
  }
  Work work(bool open) override { return script_.work = open ? Work{} : script_.work; }
  void skin(SkinState& out) override { out = {}; }

private:
  Script& script_;
};

Model model_of()
{
  Model model = test::block_model();
  Muscle muscle;
  muscle.name = "muscle";
  muscle.stress_reference = 1e4;
  muscle.rise_time = 1e-3;
  test::add_muscle(model, { { 1, 0, 0 } }, muscle);
  model.bones = { "jaw" };
  model.gravity = { { 0, 0, -9.81 } };
  model.materials[0].viscous_share = { { 0.3, 0 } };
  model.materials[0].viscous_time = { { 0.02, 0 } };
  return model;
}

struct Stepped
{
  explicit Stepped(const Model& model = model_of(), const SolverSettings& settings = {})
      : solver(std::make_shared<const Model>(model), settings,
               [this](const BackendInput& input) { return std::make_unique<ScriptedBackend>(input, script); })
  {
  }
  Script script;
  TimeStepper solver;
};

const Controls contracted{ { 0.25f }, { rigid_motion({ { 0, 0, 0.02 } }, { { 1e-4, 0, 0 } }) } };

}  // namespace

TEST(TimeStepper, plans_follow_one_another_from_the_begin_to_the_end)
{
  Stepped s;
  s.solver.advance(0.01, contracted);
  s.solver.advance(0.003, contracted);
  EXPECT_EQ(s.solver.time(), 0.01 + 0.003);
  double time = 0, latest = 0;
  std::int64_t steps = 0;
  std::vector<float> activation{ 0 };
  for (const StepPlan& plan : s.script.plans)
  {
    EXPECT_NEAR(plan.time, time, 1e-12);
    const double kick = latest > 0 ? 0.5 * (latest + plan.dt) : plan.dt;
    EXPECT_NEAR(plan.first_kick, kick, 1e-9 * kick);
    EXPECT_TRUE(plan.first_kick == plan.dt || std::abs(latest / plan.dt - 1) > 1e-9)
        << "a difference by rounding is none";
    EXPECT_EQ(plan.begin.activation, activation);
    EXPECT_GE(plan.end.activation[0], plan.begin.activation[0]);
    EXPECT_LE(plan.dt, s.solver.time_step() * 1.0001);
    ASSERT_EQ(plan.relaxation.size(), static_cast<std::size_t>(plan.steps));
    EXPECT_GT(plan.relaxation.back(), 0) << "viscous stresses relax at the end of each plan";
    double relaxed = 0;
    for (const double seconds : plan.relaxation)
    {
      EXPECT_LT(seconds, 0.005 * 0.02 + 1.01 * plan.dt);
      relaxed += seconds;
    }
    EXPECT_NEAR(relaxed, plan.steps * plan.dt, 1e-12);
    time += plan.steps * plan.dt;
    latest = plan.dt;
    steps += plan.steps;
    activation = plan.end.activation;
  }
  EXPECT_EQ(s.solver.profile().steps, steps);
  EXPECT_EQ(s.solver.controls().activation, contracted.activation);
  EXPECT_EQ(s.script.plans.back().end.bone[0].translation, contracted.bone[0].translation);
  EXPECT_EQ(s.solver.activation(), activation);
  EXPECT_GT(activation[0], 0.24f);
}

TEST(TimeStepper, ends_a_motion_between_two_plans_where_it_is_told_to)
{
  Stepped s, whole;
  EXPECT_TRUE(whole.solver.advance(0.01, contracted, [] { return true; }));
  int calls = 0;
  EXPECT_FALSE(s.solver.advance(0.01, contracted, [&] { return ++calls < 3; }));
  EXPECT_EQ(calls, 3);
  ASSERT_EQ(s.script.plans.size(), 3u);
  EXPECT_EQ(s.solver.time(), whole.script.plans[3].time);
  EXPECT_NEAR(s.solver.controls().activation[0], 0.25 * s.solver.time() / 0.01, 1e-6);
  EXPECT_TRUE(s.solver.advance(0.01 - s.solver.time(), contracted));
  EXPECT_NEAR(s.solver.time(), 0.01, 1e-12);
  EXPECT_EQ(s.solver.controls().activation, contracted.activation);

  Stepped settling;
  calls = 0;
  EXPECT_FALSE(settling.solver.settle(contracted, 1e-3, 1, [&](const Equilibrium&) { return ++calls < 2; }).reached);
  EXPECT_EQ(calls, 2);
}

// In heavy tissue steps are so long that 32 of them would last longer than muscles and bones allow.
TEST(TimeStepper, makes_short_plans_while_muscles_respond_and_bones_move)
{
  Model model = model_of();
  model.materials[0].density *= 200;
  model.muscles[0].rise_time = 0.02;
  test::hold_plane(model, 2, 0, model.size[2]);
  Stepped muscle(model);
  ASSERT_GT(32 * muscle.solver.time_step(), 8e-3);
  for (int part = 0; part < 2; ++part)
    muscle.solver.advance(0.1, { { 1.0f }, { RigidTransform() } });
  double longest = 0;
  for (const StepPlan& plan : muscle.script.plans)
    if (plan.begin.activation[0] < 0.9f)
      EXPECT_LE(plan.steps * plan.dt, 4e-3 * 1.0001);
    else
      longest = std::max(longest, plan.steps * plan.dt);
  EXPECT_GT(longest, 8e-3) << "after the muscle has responded";

  Stepped bone(model);
  const double way = 16 * model.spacing[0], seconds = 0.08;
  bone.solver.advance(seconds, { { 0.0f }, { rigid_motion({ { 0, 0, 0 } }, { { way, 0, 0 } }) } });
  for (const StepPlan& plan : bone.script.plans)
    EXPECT_LE(plan.steps * plan.dt, seconds / 32 * 1.0001) << "half a voxel";
}

TEST(TimeStepper, no_node_moves_far_in_a_step)
{
  Stepped s;
  const double longest = s.solver.time_step(), speed = 0.3 * model_of().spacing[0] / longest;
  s.solver.set_velocities(NodalVectors(model_of().nodes.size(), { { 0, 0, speed } }));
  s.solver.advance(0.01, s.solver.controls());
  for (const StepPlan& plan : s.script.plans)
    EXPECT_LE(plan.dt, 0.5001 * longest);
  s.script.velocity = std::nan("");
  EXPECT_THROW(s.solver.advance(0.01, s.solver.controls()), Diverged);
}

TEST(TimeStepper, refuses_bad_targets_and_stops_where_numbers_are_not_finite)
{
  Stepped s;
  EXPECT_THROW(s.solver.advance(-1, contracted), Error);
  EXPECT_THROW(s.solver.advance(0.01, { { 1.5f }, contracted.bone }), Error);
  EXPECT_THROW(s.solver.advance(0.01, { {}, contracted.bone }), Error);
  EXPECT_TRUE(s.script.plans.empty());
  std::unique_ptr<Snapshot> snapshot;
  s.solver.save(snapshot);
  s.script.bound = std::nan("");
  EXPECT_THROW(s.solver.advance(0.01, contracted), Diverged);
  EXPECT_EQ(s.script.plans.size(), 1u);
  EXPECT_THROW(s.solver.advance(0.01, contracted), Error);
  s.solver.restore(*snapshot);
  s.script.bound = 1;
  EXPECT_NO_THROW(s.solver.advance(1e-4, contracted));
  s.script.bound = std::nan("");
  EXPECT_THROW(s.solver.advance(0.01, contracted), Diverged);
  s.script.bound = 1;
  s.solver.reset();
  EXPECT_NO_THROW(s.solver.advance(1e-4, contracted));
}

TEST(TimeStepper, tells_the_backend_what_runs)
{
  Stepped s;
  s.solver.switch_effect(Effect::contraction, false);
  s.solver.switch_effect(Effect::contraction, false);
  s.solver.switch_effect(Effect::viscosity, false);
  const EffectSet without = effects_of(model_of()).with(Effect::contraction, false);
  EXPECT_EQ(s.script.running.size(), 2u);
  EXPECT_TRUE(s.script.running.front() == without);
  EXPECT_TRUE(s.script.running.back() == without.with(Effect::viscosity, false));
  s.solver.advance(0.01, contracted);
  for (const StepPlan& plan : s.script.plans)
  {
    EXPECT_EQ(plan.end.activation[0], 0) << "as fibres feel it";
    for (const double seconds : plan.relaxation)
      EXPECT_EQ(seconds, 0);
  }
  EXPECT_GT(s.solver.activation()[0], 0.2f) << "muscles respond all the same";
  EXPECT_THROW(s.solver.switch_effect(Effect::sliding, false), Error);
  EXPECT_THROW(s.solver.switch_effect(Effect::elasticity, false), Error);
}

TEST(TimeStepper, settles_with_relaxed_viscous_stresses_and_full_activation)
{
  Stepped s;
  const Equilibrium result = s.solver.settle(contracted, 1e-3, 1, {});
  EXPECT_TRUE(result.reached) << "nothing moves";
  for (const StepPlan& plan : s.script.plans)
  {
    EXPECT_EQ(plan.begin.activation[0], 0.25f);
    EXPECT_GT(plan.relaxation.back(), 1e6);
  }
  s.solver.advance(1e-3, contracted);
  EXPECT_LT(s.script.plans.back().relaxation.back(), 1e-3);
  EXPECT_EQ(s.script.damping.back(), model_of().damping);
}

TEST(TimeStepper, takes_back_only_its_own_motions)
{
  Stepped one, other;
  one.solver.advance(0.01, contracted);
  const std::string bytes = one.solver.pack();
  other.solver.unpack(bytes);
  EXPECT_EQ(other.solver.time(), 0.01);
  EXPECT_EQ(other.solver.activation(), one.solver.activation());
  EXPECT_EQ(other.script.plans.size(), one.script.plans.size());
  EXPECT_THROW(other.solver.unpack(bytes + "x"), Error);
  EXPECT_THROW(other.solver.unpack(bytes.substr(1)), Error);
  std::unique_ptr<Snapshot> snapshot;
  one.solver.save(snapshot);
  EXPECT_THROW(other.solver.restore(*snapshot), Error);
}

TEST(TimeStepper, keeps_a_ledger_of_stored_energies_and_of_the_work_that_the_backend_notes)
{
  SolverSettings settings;
  settings.ledger = true;
  Stepped s(model_of(), settings);
  EXPECT_EQ(s.solver.ledger().imbalance(), 0);
  EXPECT_THROW(Stepped().solver.ledger(), Error);

  s.solver.set_velocities(NodalVectors(model_of().nodes.size(), { { 0, 0, 2 } }));
  s.script.work = { 11, 7, 5, 1, 3, 2 };  // work of muscles, loads, constraints; losses to friction, damping, viscosity
  const EnergyLedger now = s.solver.ledger();
  // Velocities are half a step behind displacements, and gravity changes them within the step.
  const double mass = 1000 * 64e-9;
  EXPECT_NEAR(now["kinetic"], 0.5 * mass * 2 * (2 - 9.81 * s.solver.time_step()), 1e-12);
  EXPECT_NEAR(now.initial, now["kinetic"] + 3 + 2, 1e-12);
  EXPECT_EQ(now["internal"], 3);
  EXPECT_EQ(now["hourglass"], 2);
  EXPECT_EQ(now["gravity"], 0) << "nothing has moved";
  EXPECT_EQ(now["muscle"], 11);
  EXPECT_NEAR(now["load"], 7, 1e-12);
  EXPECT_EQ(now["constraint"], 5 + 1) << "without friction";
  EXPECT_EQ(now["friction"], 1);
  EXPECT_EQ(now.largest, 11);
  EXPECT_NEAR(now.imbalance(), 2 + 3 + 1 - 11 - 7 - 6, 1e-12);
}

TEST(TimeStepper, keeps_factors_of_growth_only_if_a_search_confirms_the_one_before)
{
  Model model = model_of();
  model.time_step_estimate = TimeStepEstimate::assembled;
  Stepped s(model);
  s.script.mass_helps = false;
  const Controls rest{ { 0 }, { RigidTransform() } }, active{ { 0.5F }, { RigidTransform() } };
  Controls moved = active;
  moved.bone[0].translation[0] = 1e-3;
  const auto advance = [&](const Controls& to)
  {
    s.script.growth.clear();
    s.solver.advance(2500 * s.solver.time_step(), to);
    std::vector<bool> keeps;
    for (const auto& call : s.script.growth)
      keeps.push_back(call.second);
    return keeps;
  };
  const std::vector<bool> first = advance(rest);
  EXPECT_FALSE(first.at(0)) << "nothing was found before";
  EXPECT_TRUE(first.at(1));
  EXPECT_FALSE(advance(active).at(0)) << "the muscle stiffens";
  for (const bool keeps : advance(moved))
    EXPECT_FALSE(keeps) << "a bone moves";
  s.script.found = 1.1 * s.script.bound;
  EXPECT_FALSE(advance(moved).at(0)) << "it finds another number";
  EXPECT_TRUE(advance(moved).at(0));
}

TEST(TimeStepper, adds_mass_where_a_search_finds_that_steps_would_be_short)
{
  Model model = model_of();
  model.time_step_estimate = TimeStepEstimate::assembled;
  model.mass_scaling.kind = MassScalingSettings::Kind::uniform;
  model.mass_scaling.in_motion = 1e-4;
  const Discretisation discretisation(model);
  const double allowed = MassInMotion(model, discretisation).allowed();
  const Controls relaxed{ { 0 }, { RigidTransform() } };
  const auto after = [&](double found)
  {
    auto s = std::make_unique<Stepped>(model, SolverSettings{ "cpu", 0, 0, true });
    s->solver.set_velocities(NodalVectors(model.nodes.size(), { { 0, 0, 0.5 } }));
    s->script.found = found;
    s->solver.advance(1e-4, relaxed);
    return s;
  };
  const auto enough = after(0.9 * allowed), little = after(1.1 * allowed), much = after(3 * allowed);
  EXPECT_EQ(enough->script.searches, 1);
  EXPECT_TRUE(enough->script.changed.empty());
  EXPECT_EQ(enough->solver.monitor().added_mass, 0);
  EXPECT_EQ(little->script.searches, 1) << "the mass counts at the next search";
  EXPECT_EQ(little->script.changed, std::vector<std::int32_t>{ 5 });
  EXPECT_EQ(much->script.searches, 2);
  EXPECT_EQ(much->script.growth.back().first, 1.5 * allowed) << "growth is measured since the latest search";
  const double added = much->solver.monitor().added_mass;
  EXPECT_GT(added, 0);
  double mass = 0;
  for (const double of_node : discretisation.node_mass)
    mass += of_node;
  EXPECT_NEAR(much->solver.ledger().initial - enough->solver.ledger().initial, 0.5 * added * mass * 0.25, 1e-9 * mass);
  std::unique_ptr<Snapshot> snapshot;
  much->solver.save(snapshot);
  much->script.changed.clear();
  much->solver.reset();
  EXPECT_EQ(much->script.changed, std::vector<std::int32_t>{ 5 });
  EXPECT_EQ(much->solver.monitor().added_mass, 0);
  much->solver.restore(*snapshot);
  EXPECT_EQ(much->solver.monitor().added_mass, added);
  // The next search first takes back a part of much mass, so that factors of before no longer hold.
  ASSERT_GT(added, 0.0075);
  much->script.growth.clear();
  much->solver.advance(400 * much->solver.time_step(), relaxed);
  EXPECT_EQ(much->script.growth.at(0), std::make_pair(std::numeric_limits<double>::infinity(), false));
}
