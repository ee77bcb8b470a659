#include "frontalis/study/effect_costs.hpp"

#include <algorithm>

namespace frontalis
{
namespace
{

// only steps are compared, so the search for the length of steps is left out
Model with_cheap_time_step(Model model)
{
  model.time_step_estimate = TimeStepEstimate::element;
  return model;
}

Model without(const Model& model, EffectSet off)
{
  Model less = with_cheap_time_step(model);
  switch_off(less, off.with(Effect::friction, off.has(Effect::friction) || off.has(Effect::sliding)));
  return less;
}

std::unique_ptr<Solver> solver_of(Model model, const SolverSettings& settings)
{
  return make_solver(std::make_shared<const Model>(std::move(model)), settings);
}

double time_of_field(Solver& solver)
{
  std::vector<float> field;
  std::vector<double> seconds;
  for (int repetition = 0; repetition < 9; ++repetition)
  {
    const double start = wall_seconds();
    solver.skin_field(SkinField::stress, field);
    seconds.push_back(wall_seconds() - start);
  }
  return spread_of(seconds).median;
}

}  // namespace

Model plain_model(const Model& model)
{
  EffectSet all = EffectSet::all();
  for (const Effect effect : every_effect())
    if (traits_of(effect).not_off[0] != '\0')
      all = all.with(effect, false);
  Model plain = without(model, all);
  for (Material& material : plain.materials)
  {
    // 3 kappa (1 - 2 nu) = 2 mu (1 + nu): any shear modulus at rest costs the same
    if (material.law != Law::neo_hookean)
      material.parameters[0] = material.parameters[1] / 50;
    material.law = Law::neo_hookean;
  }
  plain.hourglass = HourglassControl::scalar;
  plain.integration = Integration::one_point;
  return plain;
}

EffectCosts measure_effects(const std::shared_ptr<const Model>& model, const SolverSettings& settings,
                            const StepTimer& timer)
{
  const EffectSet present = effects_of(*model);
  const std::unique_ptr<Solver> whole = solver_of(with_cheap_time_step(*model), settings),
                                plain = solver_of(plain_model(*model), settings);
  const Controls rest = whole->controls();
  Controls active = rest;
  std::fill(active.activation.begin(), active.activation.end(), 0.75f);

  // what a step takes without an effect; nodes that nothing holds would fly away, so that rigid nodes are compared at
  // rest, and without the effects that would move the others
  const auto cost_of = [&](Effect effect) -> Spread
  {
    if (effect == Effect::elasticity)
    {
      const auto alone = solver_of(without(*model, present.with(effect, false)), settings);
      return spread_of(timer({ { alone.get(), active } }), 0);
    }
    if (effect != Effect::rigid_nodes)
    {
      const auto less = solver_of(without(*model, EffectSet().with(effect)), settings);
      return spread_of_difference(timer({ { whole.get(), active }, { less.get(), active } }), 0, 1);
    }
    EffectSet moving;
    for (const Effect e :
         { Effect::gravity, Effect::surface_loads, Effect::prescribed_displacement, Effect::sliding, Effect::contact })
      moving = moving.with(e);
    const auto held = solver_of(without(*model, moving), settings),
               loose = solver_of(without(*model, moving.with(effect)), settings);
    return spread_of_difference(timer({ { held.get(), rest }, { loose.get(), rest } }), 0, 1);
  };

  EffectCosts costs;
  costs.backend = whole->description();
  const StepTimes both = timer({ { whole.get(), active }, { plain.get(), active } });
  costs.step = spread_of(both, 0).median;
  costs.plain_step = spread_of(both, 1).median;
  const std::vector<Allocation> allocations = whole->allocations();
  for (const Effect effect : every_effect())
  {
    EffectCost cost{ effect, presence_of(*model, effect), 0, {} };
    for (const Allocation& allocation : allocations)
      cost.bytes += allocation.effect == effect ? allocation.bytes : 0;
    if (cost.presence.present && effect != Effect::output_fields)
      cost.step = cost_of(effect);
    costs.effects.push_back(cost);
  }
  if (present.has(Effect::output_fields))
    costs.field = time_of_field(*whole);
  return costs;
}

}  // namespace frontalis
