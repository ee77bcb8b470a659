#include "frontalis/study/effect_costs.hpp"

#include "solver/effect_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

using namespace frontalis;

namespace
{

// Given time per step of an effect [s]. A step takes the sum over the running effects.
double price_of(Effect effect) { return 1e-6 * std::pow(2, static_cast<int>(effect)); }

double price_of(EffectSet effects)
{
  double sum = 0;
  for (const Effect effect : every_effect())
    sum += effects.has(effect) ? price_of(effect) : 0;
  return sum;
}

bool is_active(const TimedSolver& timed)
{
  const auto& activation = timed.controls.activation;
  return !activation.empty() && std::all_of(activation.begin(), activation.end(), [](float a) { return a == 0.75f; });
}

// Returns given costs as times, with a disturbance that all solvers of a round share, and records the comparisons.
struct SetTimes
{
  struct Comparison
  {
    std::vector<EffectSet> effects;
    bool active = true;
  };
  std::vector<Comparison> comparisons;

  StepTimes operator()(const std::vector<TimedSolver>& solvers)
  {
    Comparison comparison;
    for (const TimedSolver& timed : solvers)
    {
      comparison.effects.push_back(timed.solver->effects());
      comparison.active = comparison.active && is_active(timed);
    }
    comparisons.push_back(comparison);
    StepTimes times;
    for (const double disturbance : { 0.0, 1.0, 0.0, 0.0, 5.0 })
    {
      times.emplace_back();
      for (const EffectSet effects : comparison.effects)
        times.back().push_back(price_of(effects) + disturbance);
    }
    return times;
  }
};

struct Measured
{
  std::shared_ptr<const Model> model;
  EffectCosts costs;
  std::vector<SetTimes::Comparison> comparisons;
};

Measured measured(unsigned effects)
{
  const auto model = std::make_shared<const Model>(test::scene_of(effects));
  SetTimes times;
  const EffectCosts costs = measure_effects(model, { "cpu", 1, 0 }, std::ref(times));
  return { model, costs, times.comparisons };
}

}  // namespace

TEST(EffectCosts, AreTheDifferenceToTheModelWithoutTheEffect)
{
  const Measured all = measured(test::everything);
  ASSERT_EQ(all.costs.effects.size(), effect_traits.size());
  EXPECT_DOUBLE_EQ(all.costs.step, price_of(effects_of(*all.model)));
  EXPECT_DOUBLE_EQ(all.costs.plain_step, price_of(Effect::elasticity));
  for (const EffectCost& cost : all.costs.effects)
  {
    // A model without sliding has no friction either, so that the cost of sliding includes that of friction.
    const double price = !cost.presence.present || cost.effect == Effect::output_fields ? 0
                         : cost.effect == Effect::sliding ? price_of(Effect::sliding) + price_of(Effect::friction)
                                                          : price_of(cost.effect);
    EXPECT_NEAR(cost.step.median, price, 1e-12) << name_of(cost.effect);
    EXPECT_NEAR(cost.step.half, cost.effect == Effect::elasticity ? 0.5 : 0, 1e-12)
        << name_of(cost.effect) << ": what disturbs both solvers of a turn is no spread of their difference";
  }
}

TEST(EffectCosts, ComparesAtActivationAndRigidNodesAtRestWithoutWhatMovesTheOthers)
{
  EffectSet moving;
  for (const Effect effect :
       { Effect::gravity, Effect::surface_loads, Effect::prescribed_displacement, Effect::sliding, Effect::friction })
    moving = moving.with(effect);
  int of_rigid_nodes = 0;
  for (const SetTimes::Comparison& comparison : measured(test::everything).comparisons)
  {
    const EffectSet less = comparison.effects.back();
    const bool compares_rigid_nodes =
        comparison.effects.size() == 2 && comparison.effects[0].without(less) == EffectSet().with(Effect::rigid_nodes);
    of_rigid_nodes += compares_rigid_nodes ? 1 : 0;
    EXPECT_NE(comparison.active, compares_rigid_nodes) << names_of(less);
    if (compares_rigid_nodes)
    {
      EXPECT_EQ(less.without(moving), less) << names_of(less);
    }
  }
  EXPECT_EQ(of_rigid_nodes, 1);
}

TEST(EffectCosts, BytesAreThoseOfTheSolversArrays)
{
  const Measured some = measured(test::viscosity | test::contraction | test::other_law);
  const auto solver = make_solver(some.model, { "cpu", 1, 0 });
  for (const EffectCost& cost : some.costs.effects)
  {
    std::size_t bytes = 0;
    for (const Allocation& allocation : solver->allocations())
      bytes += allocation.effect == cost.effect ? allocation.bytes : 0;
    EXPECT_EQ(cost.bytes, bytes) << name_of(cost.effect);
    const bool holds = cost.effect == Effect::elasticity || cost.effect == Effect::viscosity ||
                       cost.effect == Effect::contraction || cost.effect == Effect::rigid_nodes;
    EXPECT_EQ(cost.bytes > 0, holds) << name_of(cost.effect);
  }
  EXPECT_EQ(some.costs.field, 0) << "there is no skin";
}

TEST(EffectCosts, APlainModelHasElasticityAlone)
{
  const Model plain = plain_model(test::scene_of(test::everything));
  EXPECT_EQ(names_of(effects_of(plain)), "elasticity");
  for (const Material& material : plain.materials)
  {
    EXPECT_EQ(material.law, Law::neo_hookean);
    EXPECT_EQ(material.parameters[physics::slot_of(1)], 0) << "no stiffening";
  }
}

TEST(EffectCosts, OneMuscleIsTimedAgainstAll)
{
  Model model = test::scene_of(test::contraction);
  model.muscles.push_back(model.muscles[0]);
  model.muscles.back().name = "other";
  const StepTimer sum_of_activations = [](const std::vector<TimedSolver>& solvers)
  {
    StepTimes times(5);
    for (auto& turn : times)
      for (const TimedSolver& timed : solvers)
        turn.push_back(timed.controls.activation[0] + 2 * timed.controls.activation[1]);
    return times;
  };
  const ActivationCost cost =
      measure_activation(std::make_shared<const Model>(model), { "cpu", 1, 0 }, sum_of_activations);
  EXPECT_DOUBLE_EQ(cost.one, 0.75);
  EXPECT_DOUBLE_EQ(cost.all, 2.25);
  EXPECT_EQ(cost.spread, 0);
}

// The number of steps to time follows from the resolution of the clock.
TEST(StepTimes, HaveARowPerTurnAndAColumnPerSolver)
{
  const auto model = std::make_shared<const Model>(test::scene_of(test::contraction));
  const auto a = make_solver(model, { "cpu", 1, 0 }), b = make_solver(model, { "cpu", 1, 0 });
  Controls target = a->controls();
  target.activation[0] = 0.5f;
  const StepTimes times = time_in_turn({ { a.get(), target }, { b.get(), b->controls() } }, 1e-9, true, 1e9);
  EXPECT_GE(times.size(), 5U);
  for (const auto& turn : times)
    EXPECT_EQ(turn.size(), 2U);
  EXPECT_FLOAT_EQ(a->controls().activation[0], 0.5f) << "controls are reached before steps are timed";
  EXPECT_EQ(b->controls().activation[0], 0);
}
