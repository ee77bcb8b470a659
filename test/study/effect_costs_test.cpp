#include "frontalis/study/effect_costs.hpp"

#include "frontalis/study/effect_presence.hpp"

#include "solver/effect_scene.hpp"

#include <gtest/gtest.h>

using namespace frontalis;

TEST(EffectCosts, AreThoseOfTheModelsEffects)
{
  const auto model =
      std::make_shared<const Model>(test::scene_of(test::viscosity | test::contraction | test::other_law));
  const EffectCosts costs = measure_effects(model, { "cpu", 1, 0 }, 0.01);
  ASSERT_EQ(costs.effects.size(), effect_traits.size());
  EXPECT_GT(costs.step, 0);
  EXPECT_GT(costs.plain_step, 0);
  EXPECT_EQ(costs.field, 0) << "there is no skin";
  for (const EffectCost& cost : costs.effects)
  {
    if (cost.effect == Effect::elasticity)
    {
      EXPECT_GT(cost.step, 0);
    }
    if (cost.effect == Effect::viscosity || cost.effect == Effect::contraction)
    {
      EXPECT_GT(cost.bytes, 0u) << name_of(cost.effect);
    }
    if (cost.presence.present)
      continue;
    EXPECT_EQ(cost.bytes, 0u) << name_of(cost.effect);
    EXPECT_EQ(cost.step, 0) << name_of(cost.effect);
  }
}

TEST(EffectCosts, APlainModelHasElasticityAlone)
{
  const Model plain = plain_model(test::scene_of(test::everything));
  EXPECT_EQ(names_of(effects_of(plain)), "elasticity");
  for (const Material& material : plain.materials)
    EXPECT_EQ(material.law, Law::neo_hookean);
}

TEST(EffectCosts, OneMuscleIsTimedAgainstAll)
{
  const auto model = std::make_shared<const Model>(test::scene_of(test::contraction));
  const ActivationCost cost = measure_activation(model, { "cpu", 1, 0 }, 0.01);
  EXPECT_GT(cost.one, 0);
  EXPECT_GT(cost.all, 0);
}
