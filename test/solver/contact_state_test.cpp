// Tissue that touches rigid bodies: memory, snapshots, switching, and the time step.

#include "bodies_touch.hpp"

#include "frontalis/model/effects.hpp"

namespace frontalis
{
namespace
{

using namespace test;

TEST_P(BodiesTouch, one_that_is_not_there_costs_nothing)
{
  const Model touched = block_and_finger(0.3);
  EXPECT_TRUE(effects_of(touched).has(Effect::contact));
  EXPECT_EQ(presence_of(touched, Effect::contact).nodes, touched.contacts[0].points.size());
  Model off = touched, never = touched;
  switch_off(off, EffectSet().with(Effect::contact));
  never.contacts.clear();
  check_model(off);
  std::size_t bytes = 0;
  for (const Allocation& allocation : make(touched)->allocations())
    bytes += allocation.effect == Effect::contact ? allocation.bytes : 0;
  EXPECT_GT(bytes, 100 * touched.contacts[0].points.size());
  for (const Model& model : { off, never })
  {
    const auto solver = make(model);
    EXPECT_TRUE(solver->reactions().empty());
    for (const Allocation& allocation : solver->allocations())
      EXPECT_NE(allocation.effect, Effect::contact) << allocation.what;
  }
}

TEST_P(BodiesTouch, a_motion_goes_on_with_the_same_bits)
{
  const Model model = block_and_finger(0.4);
  const auto solver = make(model), other = make(model);
  press_and_stroke(*solver, 10e-3);
  std::unique_ptr<Snapshot> snapshot;
  solver->save(snapshot);
  const std::string bytes = solver->pack();
  press_and_stroke(*solver, 4e-3);
  const Vectors expected = displacements(*solver);
  const Reaction reaction = solver->reactions()[0];
  EXPECT_GT(std::abs(reaction.force[0]), 1e-3);
  solver->restore(*snapshot);
  other->unpack(bytes);
  for (Solver* const again : { solver.get(), other.get() })
  {
    press_and_stroke(*again, 4e-3);
    EXPECT_EQ(displacements(*again), expected);
    EXPECT_EQ(again->reactions()[0].force, reaction.force);
  }
}

TEST_P(BodiesTouch, any_number_of_threads_gives_the_same_bits)
{
  const Model model = block_and_finger(0.4);
  Vectors expected;
  for (const int threads : { 1, 2, 3 })
  {
    const auto solver = make(model, threads, true);
    press_and_stroke(*solver, 10e-3);
    if (expected.empty())
      expected = displacements(*solver);
    EXPECT_EQ(displacements(*solver), expected) << threads;
  }
}

// Points of two bodies share the blocks of sixteen that are evaluated together. The solver in double precision
// evaluates them one by one.
TEST(PointsOfContact, every_instruction_set_finds_the_forces_of_single_points)
{
  Model model = block_and_finger(0.4, true);
  model.contacts.push_back(model.contacts[0]);
  model.contacts[0].bone = 0;  // it stands still and does not touch
  const auto run = [&](int threads)
  {
    auto solver = make_solver(std::make_shared<const Model>(model), { "cpu", threads, 1e-5 });
    press_and_stroke(*solver, 5e-3);
    return solver;
  };
  model.precision = Precision::double_precision;
  const auto expected = run(1);
  const std::array<double, 3> force = expected->reactions()[1].force;
  EXPECT_GT(std::abs(force[2]), 1e-3);
  model.precision = Precision::single;
  for (const char* instructions : { "baseline", "avx2", "avx512" })
  {
    ::setenv("FRONTALIS_INSTRUCTION_SET", instructions, 1);
    bool available = true;
    try
    {
      make_solver(std::make_shared<const Model>(model), { "cpu", 1 });
    }
    catch (const Error&)
    {
      available = false;  // on this machine
    }
    EXPECT_TRUE(available || std::string(instructions) != "baseline");
    if (available)
    {
      const auto one = run(1);
      for (std::size_t axis : { 0, 2 })
        EXPECT_NEAR(one->reactions()[1].force[axis], force[axis], 1e-3 * std::abs(force[axis])) << instructions;
      for (const int threads : { 2, 3 })
        EXPECT_EQ(displacements(*run(threads)), displacements(*one)) << instructions << threads;
    }
    ::unsetenv("FRONTALIS_INSTRUCTION_SET");
  }
}

TEST_P(BodiesTouch, contact_is_switched_while_running)
{
  const Model model = block_and_finger(0.4);
  Model without = model;
  switch_off(without, EffectSet().with(Effect::contact));
  const auto solver = make(model), other = make(without);
  solver->switch_effect(Effect::contact, false);
  for (Solver* const one : { solver.get(), other.get() })
    press_and_stroke(*one, 4e-3);
  EXPECT_EQ(displacements(*solver), displacements(*other));
  solver->switch_effect(Effect::contact, true);
  const double stroke = 10e-3;
  solver->advance(stroke, solver->controls());
  EXPECT_GT(solver->reactions()[0].force[2], 1e-3);
  solver->switch_effect(Effect::contact, false);
  EXPECT_EQ(solver->reactions()[0].force[2], 0);
  solver->switch_effect(Effect::contact, true);
  solver->reset();
  const auto fresh = make(model);
  for (Solver* const one : { solver.get(), fresh.get() })
    press_and_stroke(*one, 4e-3);
  EXPECT_EQ(displacements(*solver), displacements(*fresh));
}

// The true frequency stays below the bound. The bound assumes contact at all points, but shortens steps only a little.
TEST_P(BodiesTouch, the_time_step_is_that_of_a_model_in_contact)
{
  Model model = block_and_finger(0), without = model;
  without.contacts.clear();
  const double with = make(model)->time_step(), plain = make(without)->time_step();
  EXPECT_LT(with, plain);
  EXPECT_GT(with, 0.97 * plain);
  // The motion has no damping and makes full time steps while in contact.
  model.damping = 0;
  model.time_step_share = 1;
  for (const auto estimate : { TimeStepEstimate::element, TimeStepEstimate::assembled })
  {
    model.time_step_estimate = estimate;
    const auto solver = make(model, 2, true);
    press_and_stroke(*solver, 10e-3);
    const double before = mechanical(solver->ledger());
    for (int slice = 0; slice < 10; ++slice)
      solver->advance(1e-3, solver->controls());
    EXPECT_NEAR(mechanical(solver->ledger()), before, 0.02 * before);
  }
}

FRONTALIS_EVERY_BACKEND(BodiesTouch);

}  // namespace
}  // namespace frontalis
