// Tissue that touches itself: memory, snapshots, switching, and the time step.

#include "tissues_touch.hpp"

#include "frontalis/model/effects.hpp"

namespace frontalis
{
namespace
{

using namespace test;

// A folded sheet whose arms are pressed together obliquely.
Model pressed_fold()
{
  BlockSettings settings;
  settings.voxels = { { 10, 4, 3 } };
  settings.damping = 200;
  Model model = folded_sheet(settings, 8, 0.3);
  hold_plane(model, 2);
  model.gravity = { { 30, 20, -300 } };
  return model;
}

constexpr double until_touching = 12e-3;

double stored(Solver& solver) { return solver.ledger()["contact_stored"]; }

TEST_P(TissuesTouch, none_costs_nothing)
{
  const Model touched = pressed_fold();
  EXPECT_TRUE(effects_of(touched).has(Effect::self_contact));
  EXPECT_EQ(presence_of(touched, Effect::self_contact).nodes, touched.self_contacts[0].surface.vertices.size());
  Model off = touched, never = touched;
  switch_off(off, EffectSet().with(Effect::self_contact));
  never.self_contacts.clear();
  check_model(off);
  for (const Model& model : { off, never })
  {
    const auto solver = make(model);
    for (const Allocation& allocation : solver->allocations())
      EXPECT_NE(allocation.effect, Effect::self_contact) << allocation.what;
    EXPECT_GT(solver->time_step(), make(touched)->time_step());
  }
  std::size_t bytes = 0;
  for (const Allocation& allocation : make(touched)->allocations())
    bytes += allocation.effect == Effect::self_contact ? allocation.bytes : 0;
  EXPECT_GT(bytes, 100 * touched.self_contacts[0].surface.vertices.size());
}

TEST_P(TissuesTouch, a_motion_goes_on_with_the_same_bits)
{
  const Model model = pressed_fold();
  // Without a ledger, patches make many steps per launch.
  for (const bool ledger : { true, false })
  {
    const auto solver = make(model, 2, ledger), other = make(model, 2, ledger);
    const auto energy_of = [&](Solver& of) { return ledger ? stored(of) : 0; };
    // The snapshot is taken at several stages of the search for contact.
    for (const double start : { 0.5e-3, 0.9 * until_touching, until_touching + 3e-3 })
    {
      solver->reset();
      solver->advance(start, solver->controls());
      std::unique_ptr<Snapshot> snapshot;
      solver->save(snapshot);
      const std::string bytes = solver->pack();
      solver->advance(5e-3, solver->controls());
      const Vectors expected = displacements(*solver);
      const double energy = energy_of(*solver);
      EXPECT_TRUE(start < until_touching || !ledger || energy > 0);
      solver->restore(*snapshot);
      other->unpack(bytes);
      for (Solver* const again : { solver.get(), other.get() })
      {
        again->advance(5e-3, again->controls());
        EXPECT_EQ(displacements(*again), expected) << start;
        EXPECT_EQ(energy_of(*again), energy) << start;
      }
    }
  }
}

TEST_P(TissuesTouch, any_number_of_threads_gives_the_same_bits)
{
  const Model model = pressed_fold();
  Vectors expected;
  double energy = 0;
  for (const int threads : { 1, 2, 3 })
  {
    const auto solver = make(model, threads, true);
    solver->advance(until_touching + 8e-3, solver->controls());
    if (threads == 1)
    {
      expected = displacements(*solver);
      energy = stored(*solver);
      EXPECT_GT(energy, 0);
    }
    EXPECT_EQ(displacements(*solver), expected) << threads;
    EXPECT_EQ(stored(*solver), energy) << threads;
  }
}

TEST_P(TissuesTouch, self_contact_is_switched_while_running)
{
  const Model model = pressed_fold();
  Model without = model;
  switch_off(without, EffectSet().with(Effect::self_contact));
  // The bound of the time step also includes contact while it is switched off, so that equal steps need a fixed length.
  const double dt = 1e-5;
  const auto solver = make(model, 2, true, dt), other = make(without, 2, true, dt);
  solver->switch_effect(Effect::self_contact, false);
  for (Solver* const one : { solver.get(), other.get() })
    one->advance(4e-3, one->controls());
  EXPECT_EQ(displacements(*solver), displacements(*other));
  solver->switch_effect(Effect::self_contact, true);
  solver->advance(until_touching, solver->controls());
  EXPECT_GT(stored(*solver), 0);
  solver->switch_effect(Effect::self_contact, false);
  EXPECT_EQ(stored(*solver), 0);
  solver->switch_effect(Effect::self_contact, true);
  solver->reset();
  const auto fresh = make(model, 2, true, dt);
  for (Solver* const one : { solver.get(), fresh.get() })
    one->advance(until_touching, one->controls());
  EXPECT_EQ(displacements(*solver), displacements(*fresh));
}

// The bound of the highest frequency holds with all vertices in contact, and contact adds only a few steps.
TEST_P(TissuesTouch, the_time_step_is_that_of_a_model_in_contact)
{
  BlockSettings settings;
  settings.voxels = { { 5, 4, 4 } };
  Model model = two_blocks(settings), without = model;
  without.self_contacts.clear();
  const double with = make(model)->time_step(), plain = make(without)->time_step();
  EXPECT_LT(with, plain);
  EXPECT_GT(with, 0.96 * plain);
  // The blocks have no damping, make full time steps, and are pressed together by their weight.
  model.gravity = { { 0, 0, -200 } };
  model.time_step_share = 1;
  hold_plane(model, 2);
  for (const auto estimate : { TimeStepEstimate::element, TimeStepEstimate::assembled })
  {
    model.time_step_estimate = estimate;
    const auto solver = make(model, 2, true);
    solver->set_displacements(lowered(model, -1e-3));
    const double before = solver->ledger().initial;
    double largest = 0;
    for (int slice = 0; slice < 20; ++slice)
    {
      solver->advance(1e-3, solver->controls());
      const EnergyLedger ledger = solver->ledger();
      largest = std::max(largest, mechanical(ledger));
      EXPECT_NEAR(mechanical(ledger) - ledger["gravity"], before, 0.02 * largest) << slice;
    }
    EXPECT_GT(largest, 1e-7);
  }
}

FRONTALIS_EVERY_BACKEND(TissuesTouch);

}  // namespace
}  // namespace frontalis
