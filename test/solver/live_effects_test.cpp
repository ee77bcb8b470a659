// Effects that are switched off and on in a running solver, and their memory.

#include "backends.hpp"
#include "effect_scene.hpp"
#include "frontalis/error.hpp"
#include "frontalis/model/effects.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace frontalis
{
namespace
{

using namespace test;

// A model with all effects. Each is strong enough to be noticed among the others.
Model whole_scene()
{
  Model model = scene_of(everything);
  for (double& g : model.gravity)
    g *= 10;
  model.muscles[0].stress_reference *= 4;
  for (Load& load : model.loads)
    if (load.kind == Load::Kind::displacement)
    {
      load.fixed[0] = true;
      load.value[0] = 8e-4;
    }
  return model;
}

constexpr double dt = 4e-6;

std::vector<Effect> live_effects()
{
  std::vector<Effect> effects;
  for (const Effect effect : every_effect())
    // Contact and shells have tests of their own, because scene_of() does not include them.
    if (traits_of(effect).not_live[0] == '\0' && effect != Effect::contact && effect != Effect::self_contact &&
        effect != Effect::shell)
      effects.push_back(effect);
  return effects;
}

std::map<std::string, std::size_t> bytes_of(const Solver& solver)
{
  std::map<std::string, std::size_t> bytes;
  for (const Allocation& a : solver.allocations())
    bytes[name_of(a.effect) + ": " + a.what] += a.bytes;
  return bytes;
}

class LiveEffects : public EveryBackend
{
protected:
  std::unique_ptr<Solver> make(const Model& model, double time_step = dt) const
  {
    return make_solver(std::make_shared<const Model>(model), { GetParam(), 2, time_step });
  }
  static void go(Solver& solver, double seconds = 8e-4)
  {
    Controls controls = solver.controls();
    std::fill(controls.activation.begin(), controls.activation.end(), 0.7f);
    solver.advance(seconds, controls);
  }
  static Vectors displacements(const Solver& solver)
  {
    Vectors u;
    solver.displacements(u);
    return u;
  }
};

// Switches an effect. Friction is switched off before sliding, because it requires sliding.
void switch_live(Solver& solver, Effect effect, bool on)
{
  if (effect == Effect::sliding && !on)
    solver.switch_effect(Effect::friction, false);
  solver.switch_effect(effect, on);
}

// Each effect changes the motion. Otherwise the comparisons below could not fail.
TEST_P(LiveEffects, each_is_felt)
{
  const auto whole = make(whole_scene());
  go(*whole);
  for (const Effect effect : live_effects())
  {
    const auto solver = make(whole_scene());
    switch_live(*solver, effect, false);
    go(*solver);
    EXPECT_GT(difference(displacements(*solver), displacements(*whole)), 6e-3) << name_of(effect);
  }
}

EffectSet with_dependents(Effect effect)
{
  return EffectSet().with(effect).with(Effect::friction, effect == Effect::sliding || effect == Effect::friction);
}

TEST_P(LiveEffects, one_that_is_off_moves_nothing_and_pairs_neither)
{
  for (const Effect first : live_effects())
    for (const Effect second : live_effects())
    {
      if (second < first)
        continue;
      Model without = whole_scene();
      switch_off(without, with_dependents(first).with(second).with(Effect::friction,
                                                                   with_dependents(first).has(Effect::friction) ||
                                                                       with_dependents(second).has(Effect::friction)));
      const auto solver = make(whole_scene());
      for (const Effect effect : { first, second })
        switch_live(*solver, effect, false);
      EXPECT_EQ(solver->effects(), effects_of(without));
      const auto expected = make_solver(std::make_shared<const Model>(without), { "reference", 1, dt });
      go(*solver);
      go(*expected);
      EXPECT_LT(difference(displacements(*solver), displacements(*expected)), 2e-3)
          << name_of(first) << ", " << name_of(second);
    }
}

TEST_P(LiveEffects, one_that_comes_back_acts_again_without_its_history)
{
  for (const Effect effect : live_effects())
  {
    const auto solver = make(whole_scene());
    solver->monitor();  // the first call allocates memory
    const auto bytes = bytes_of(*solver);
    go(*solver, 4e-4);
    switch_live(*solver, effect, false);
    EXPECT_FALSE(solver->effects().has(effect));
    go(*solver, 2e-4);
    EXPECT_EQ(bytes_of(*solver), bytes) << name_of(effect);
    solver->switch_effect(effect, true);
    if (effect == Effect::viscosity)
    {
      // No stress has relaxed, so that the forces are those of an elastic body of the same shape.
      Model elastic = whole_scene();
      switch_off(elastic, EffectSet().with(Effect::viscosity));
      const auto other = make(elastic);
      Controls same = other->controls();
      std::fill(same.activation.begin(), same.activation.end(), 0.7f);
      other->advance(dt, same);
      other->set_displacements(displacements(*solver));
      Vectors forces, expected;
      solver->internal_forces(forces);
      other->internal_forces(expected);
      EXPECT_LT(difference(forces, expected), 1e-4);
    }
    go(*solver, 4e-4);
    EXPECT_TRUE(solver->monitor().finite) << name_of(effect);
    // reset() does not switch effects. The motion from rest equals that of a solver that was never switched.
    if (effect == Effect::sliding)
      solver->switch_effect(Effect::friction, true);
    solver->reset();
    const auto fresh = make(whole_scene());
    go(*solver);
    go(*fresh);
    EXPECT_EQ(displacements(*solver), displacements(*fresh)) << name_of(effect);
  }
}

TEST_P(LiveEffects, a_motion_gone_back_to_has_the_effects_of_now)
{
  const Model model = whole_scene();
  for (const Effect effect : live_effects())
  {
    const auto solver = make(model), expected = make(model);
    std::unique_ptr<Snapshot> snapshot;
    go(*solver, 2e-4);
    go(*expected, 2e-4);
    solver->save(snapshot);
    go(*solver, 2e-4);
    switch_live(*solver, effect, false);
    solver->restore(*snapshot);
    switch_live(*expected, effect, false);
    go(*solver);
    go(*expected);
    EXPECT_EQ(displacements(*solver), displacements(*expected)) << name_of(effect);
  }
}

TEST_P(LiveEffects, the_time_step_follows)
{
  Model model = scene_of(everything);
  model.muscles[0].stress_reference = 2e6;
  const auto solver = make(model, 0);
  const double before = solver->time_step();
  solver->switch_effect(Effect::fibre_stiffness, false);
  const double active = solver->time_step();
  solver->switch_effect(Effect::contraction, false);
  const double without = solver->time_step();
  EXPECT_GT(active, 1.1 * before);
  EXPECT_GT(without, 1.1 * active);
  switch_off(model, EffectSet().with(Effect::contraction).with(Effect::fibre_stiffness));
  EXPECT_NEAR(without, make(model, 0)->time_step(), 1e-6 * without);
  solver->switch_effect(Effect::contraction, true);
  solver->switch_effect(Effect::fibre_stiffness, true);
  EXPECT_NEAR(solver->time_step(), before, 1e-6 * before);
}

TEST_P(LiveEffects, what_is_not_there_or_cannot_be_switched_is_refused)
{
  const auto refusal = [this](unsigned scene, Effect effect, bool on)
  {
    const auto solver = make(scene_of(scene));
    const EffectSet before = solver->effects();
    try
    {
      solver->switch_effect(effect, on);
    }
    catch (const Error& error)
    {
      EXPECT_EQ(solver->effects(), before);
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal(0, Effect::viscosity, false),
            "the model has no viscosity (no material is viscous); it has elasticity, rigid_nodes");
  EXPECT_EQ(refusal(everything, Effect::elasticity, false),
            "elasticity cannot be switched while running: nothing else holds a voxel together");
  EXPECT_EQ(refusal(everything, Effect::rigid_nodes, false),
            "rigid_nodes cannot be switched while running: the tissue would come off its bones");
  EXPECT_EQ(refusal(everything, Effect::sliding, false),
            "friction needs sliding: switch friction off too, or sliding on");
}

TEST_P(LiveEffects, sliding_does_not_come_back_where_nodes_have_left_their_surface)
{
  const Model model = whole_scene();
  const auto solver = make(model);
  switch_live(*solver, Effect::sliding, false);
  Vectors u = displacements(*solver);
  for (const double share : { 0.2, 0.8, 30.0 })
  {
    for (const SlidingNode& node : model.sliding)
      u[node.node].fill(share * model.spacing[0]);
    solver->set_displacements(u);
    if (share < 0.5)
    {
      solver->switch_effect(Effect::sliding, true);
      solver->switch_effect(Effect::sliding, false);
    }
    else
      EXPECT_THROW(solver->switch_effect(Effect::sliding, true), Error);
  }
  EXPECT_FALSE(solver->effects().has(Effect::sliding));
  solver->reset();
  // A node that moves with its bone stays at its distance from it.
  Controls controls = solver->controls();
  for (RigidTransform& bone : controls.bone)
    bone.translation[1] = 0.3 * model.spacing[0];
  solver->advance(2e-3, controls);
  solver->switch_effect(Effect::sliding, true);
  EXPECT_TRUE(solver->effects().has(Effect::sliding));
}

// A solver that is made without an effect has the same memory as for a model without the effect, whatever its other
// effects.
TEST_P(LiveEffects, an_effect_that_was_switched_off_holds_what_one_holds_that_never_was)
{
  const std::map<Effect, unsigned> bit{ { Effect::viscosity, viscosity },
                                        { Effect::gravity, gravity },
                                        { Effect::surface_loads, pressure },
                                        { Effect::prescribed_displacement, prescribed },
                                        { Effect::fibre_stiffness, passive_fibres } };
  for (const auto& [effect, mask] : bit)
    for (const unsigned others : { 0u, unsigned{ but_friction } })
    {
      const unsigned without = others & ~mask;
      Model off = scene_of(without | mask | (effect == Effect::fibre_stiffness ? contraction : 0u));
      switch_off(off, EffectSet().with(effect));
      const Model never = scene_of(without | (effect == Effect::fibre_stiffness ? contraction : 0u));
      EXPECT_EQ(bytes_of(*make(off)), bytes_of(*make(never))) << name_of(effect) << " beside " << others;
      for (const Allocation& a : make(off)->allocations())
        EXPECT_NE(a.effect, effect) << a.what;
    }
  Model off = scene_of(everything);
  switch_off(off, EffectSet().with(Effect::rigid_nodes));
  EXPECT_EQ(bytes_of(*make(off)), bytes_of(*make(scene_of(everything | loose))));
  off = scene_of(everything);
  switch_off(off, EffectSet().with(Effect::friction));
  EXPECT_EQ(bytes_of(*make(off)), bytes_of(*make(scene_of(but_friction))));
  off = scene_of(everything);
  switch_off(off, EffectSet().with(Effect::sliding).with(Effect::friction));
  EXPECT_EQ(bytes_of(*make(off)), bytes_of(*make(scene_of(everything & ~(sliding | friction)))));
  off = scene_of(everything);
  switch_off(off, EffectSet().with(Effect::contraction).with(Effect::fibre_stiffness));
  auto without_fibres = bytes_of(*make(off)),
       never = bytes_of(*make(scene_of(everything & ~(contraction | passive_fibres))));
  // The memory of controls differs, because muscles keep their names and accept activations.
  without_fibres.erase("elasticity: controls");
  never.erase("elasticity: controls");
  EXPECT_EQ(without_fibres, never);
}

// Memory that a solver allocates on request appears in its list.
TEST_P(LiveEffects, what_is_made_on_request_is_listed_from_then_on)
{
  SolverSettings settings{ GetParam(), 2, dt };
  settings.ledger = true;
  const auto model = std::make_shared<const Model>(scene_of(everything));
  const auto booked = make_solver(model, settings);
  auto with = bytes_of(*booked), without = bytes_of(*make(*model));
  EXPECT_EQ(without.count("elasticity: account of energies"), 0u);
  // The ledger needs at least the velocities of each node before and after its update.
  EXPECT_GE(with["elasticity: account of energies"], 6 * sizeof(float) * model->nodes.size());
  if (GetParam() != "cuda")
    return;
  booked->monitor();
  EXPECT_GE(bytes_of(*booked)["elasticity: what the monitor looks at"], 36 * model->voxels.size());
  Model estimated = *model;
  estimated.time_step_estimate = TimeStepEstimate::assembled;
  const auto assembled = make(estimated, 0);
  assembled->advance(8e-4, assembled->controls());
  EXPECT_GE(bytes_of(*assembled)["elasticity: search for the highest frequency"],
            6 * 4 * sizeof(float) * model->nodes.size());
}

TEST_P(LiveEffects, SwitchedFibresEndTheMeasureOfGrowth)
{
  Model model = scene_of(everything);
  model.time_step_estimate = TimeStepEstimate::assembled;
  const auto moved = make(model, 0), set = make(model, 0);
  go(*moved);
  for (const auto* solver : { &moved, &set })
    (*solver)->switch_effect(Effect::contraction, false);
  set->set_displacements(displacements(*moved));
  const double critical = set->monitor().critical_time_step;
  EXPECT_NEAR(moved->monitor().critical_time_step, critical, 1e-3 * critical);
}

FRONTALIS_EVERY_BACKEND(LiveEffects);

}  // namespace
}  // namespace frontalis
