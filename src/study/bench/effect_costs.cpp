#include "frontalis/study/effect_costs.hpp"

#include "frontalis/study/step_time.hpp"

#include <algorithm>
#include <chrono>

namespace frontalis
{
namespace
{

// steps are compared: what is spent on finding their length is left out
Model timed(Model model)
{
  model.time_step_estimate = TimeStepEstimate::element;
  return model;
}

Model without(const Model& model, EffectSet off)
{
  Model less = timed(model);
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
    const auto start = std::chrono::steady_clock::now();
    solver.skin_field(SkinField::stress, field);
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
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

EffectCosts measure_effects(const std::shared_ptr<const Model>& model, const SolverSettings& settings, double seconds)
{
  const std::unique_ptr<Solver> whole = solver_of(timed(*model), settings),
                                plain = solver_of(plain_model(*model), settings);
  const Controls rest = whole->controls();
  Controls controls = rest;
  std::fill(controls.activation.begin(), controls.activation.end(), 0.75f);
  EffectCosts costs;
  costs.backend = whole->description();
  std::vector<double> steps, plain_steps;
  for (const auto& turn :
       time_in_turn({ { whole.get(), controls }, { plain.get(), controls } }, seconds, is_alone(settings)))
  {
    steps.push_back(turn[0]);
    plain_steps.push_back(turn[1]);
  }
  costs.step = spread_of(steps).median;
  costs.plain_step = spread_of(plain_steps).median;
  const std::vector<Allocation> allocations = whole->allocations();
  const EffectSet present = effects_of(*model);
  for (const Effect effect : every_effect())
  {
    EffectCost cost{ effect, presence_of(*model, effect), 0, 0, 0 };
    for (const Allocation& allocation : allocations)
      cost.bytes += allocation.effect == effect ? allocation.bytes : 0;
    if (effect == Effect::elasticity)
    {
      EffectSet others = present.with(Effect::elasticity, false);
      const auto alone = solver_of(without(*model, others), settings);
      std::vector<double> alone_steps;
      for (const auto& turn : time_in_turn({ { alone.get(), controls } }, seconds, is_alone(settings)))
        alone_steps.push_back(turn[0]);
      const Spread spread = spread_of(alone_steps);
      cost.step = spread.median;
      cost.spread = spread.half;
    }
    else if (cost.presence.present && effect != Effect::output_fields)
    {
      // tissue that nothing holds must not be moved: it is compared at rest, and what would move it is left out
      const bool rigid = effect == Effect::rigid_nodes;
      const EffectSet moving = rigid ? EffectSet()
                                           .with(Effect::gravity)
                                           .with(Effect::surface_loads)
                                           .with(Effect::prescribed_displacement)
                                           .with(Effect::sliding)
                                     : EffectSet();
      const auto beside = rigid ? solver_of(without(*model, moving), settings) : nullptr;
      Solver* const more = rigid ? beside.get() : whole.get();
      const auto less = solver_of(without(*model, moving.with(effect)), settings);
      std::vector<double> differences;
      const Controls& at = rigid ? rest : controls;
      for (const auto& turn : time_in_turn({ { more, at }, { less.get(), at } }, seconds, is_alone(settings)))
        differences.push_back(turn[0] - turn[1]);
      const Spread spread = spread_of(differences);
      cost.step = spread.median;
      cost.spread = spread.half;
    }
    costs.effects.push_back(cost);
  }
  if (present.has(Effect::output_fields))
    costs.field = time_of_field(*whole);
  return costs;
}

}  // namespace frontalis
