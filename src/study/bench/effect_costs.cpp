#include "frontalis/study/effect_costs.hpp"

#include "frontalis/model/sample_field.hpp"
#include "frontalis/study/voxel_model.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

// Selects the time step that is cheapest to compute, because the cost of steps is compared and not their length.
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

Controls active_controls(const Solver& solver)
{
  Controls controls = solver.controls();
  std::fill(controls.activation.begin(), controls.activation.end(), 0.75f);
  return controls;
}

constexpr std::int32_t block_length = 64, block_depth = 40;  // size of the block of measure_presence() [voxels]

// Gives an effect to a fraction of the voxels, or of the nodes of the face z = 0.
void give(Model& model, Effect effect, double share)
{
  const auto rows = static_cast<std::int32_t>(std::lround(share * block_depth));
  const auto has = [&](std::size_t e) { return model.voxels[e][1] < rows; };
  if (effect == Effect::viscosity)
  {
    model.materials.push_back(model.materials[0]);
    model.materials.back().viscous_share = { { 0.3, 0.2 } };
    model.materials.back().viscous_time = { { 0.1, 1 } };
    mix(model, [&](std::size_t e) { return Mixture{ { has(e) ? 1 : 0, 1.0F } }; });
  }
  if (effect == Effect::contraction || effect == Effect::fibre_stiffness)
  {
    const Muscle muscle{ "pull", 1e3, effect == Effect::fibre_stiffness };
    add_muscles(model, { muscle },
                [&](std::size_t e) {
                  return has(e) ? std::vector<Fibre>{ { 0, along_x(e) } } : std::vector<Fibre>();
                });
  }
  if (effect == Effect::sliding || effect == Effect::friction)
  {
    // The cost of friction is measured in addition to that of sliding, so that all nodes of the face slide.
    const std::int32_t sliding_rows = effect == Effect::friction ? block_depth + 1 : rows;
    const std::int32_t rough_rows = effect == Effect::friction ? rows : 0;
    const auto slide_between = [&](const char* floor, std::int32_t first, std::int32_t last)
    {
      slide_on(
          model, floor, [](const Point& p) { return p[2]; },
          nodes_where(model,
                      [&](const Point& p)
                      {
                        const double row = p[1] / model.spacing[1];
                        return p[2] == 0 && p[0] > 0 && row > first - 0.5 && row < last - 0.5;
                      }));
    };
    slide_between("smooth floor", rough_rows, sliding_rows);
    if (rough_rows > 0)
    {
      slide_between("rough floor", 0, rough_rows);
      model.constraint_surfaces.back().friction = 0.3;
    }
  }
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
    // The bulk modulus is kept. Poisson's ratio becomes 0.49, which does not affect the cost.
    const double bulk = material.parameters[physics::bulk_modulus_slot];
    material.parameters = { { material.law == Law::neo_hookean ? material.parameters[0] : bulk / 50, bulk } };
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
  const Controls rest = whole->controls(), active = active_controls(*whole);

  // Time per step that an effect adds. A model without rigid nodes would fly away, so that the cost of rigid nodes is
  // measured at rest and without the effects that cause motion.
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
    for (const Effect e : every_effect())
      moving = moving.with(e, e != effect && presence_of(*model, e).nodes > 0);
    const auto held = solver_of(without(*model, moving), settings),
               loose = solver_of(without(*model, moving.with(effect)), settings);
    return spread_of_difference(timer({ { held.get(), rest }, { loose.get(), rest } }), 0, 1);
  };

  EffectCosts costs;
  costs.backend = whole->description();
  const StepTimes both = timer({ { whole.get(), active }, { plain.get(), active } });
  costs.step = spread_of(both, 0).median;
  costs.plain_step = spread_of(both, 1).median;
  if (!model->muscles.empty())
    costs.activation = whole->controls().activation[0];
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

std::vector<double> presence_shares() { return { 0, 0.1, 0.5, 1 }; }

std::vector<PresenceCost> measure_presence(const SolverSettings& settings, double seconds)
{
  // The addresses of a solver's arrays change its time per step by about 1 %, so that each solver is created several
  // times.
  constexpr int rounds = 4;
  const StepTimer timer = step_timer(settings, seconds / rounds);
  const std::vector<double> shares = presence_shares();
  std::vector<PresenceCost> costs;
  for (const Effect effect :
       { Effect::contraction, Effect::fibre_stiffness, Effect::viscosity, Effect::sliding, Effect::friction })
  {
    StepTimes times;
    for (int round = 0; round < rounds; ++round)
    {
      std::vector<std::unique_ptr<Solver>> solvers;
      std::vector<TimedSolver> timed;
      for (const double share : shares)
      {
        Model model = dense_block(block_length, block_depth, block_depth);
        model.gravity = {};
        give(model, effect, share);
        solvers.push_back(solver_of(std::move(model), settings));
        timed.push_back({ solvers.back().get(), active_controls(*solvers.back()) });
      }
      const StepTimes more = timer(timed);
      times.insert(times.end(), more.begin(), more.end());
    }
    for (std::size_t s = 0; s < shares.size(); ++s)
      costs.push_back({ effect, shares[s], spread_of_difference(times, s, 0), spread_of(times, 0).median });
  }
  return costs;
}

ActivationCost measure_activation(const std::shared_ptr<const Model>& model, const SolverSettings& settings,
                                  const StepTimer& timer)
{
  const auto one = make_solver(model, settings), all = make_solver(model, settings);
  Controls of_one = one->controls();
  of_one.activation.at(0) = 0.75f;
  const StepTimes times = timer({ { one.get(), of_one }, { all.get(), active_controls(*all) } });
  return { spread_of(times, 0).median, spread_of(times, 1).median, spread_of_difference(times, 1, 0).half };
}

}  // namespace frontalis
