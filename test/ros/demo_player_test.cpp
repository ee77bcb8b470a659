#include "frontalis/ros/demo_player.hpp"

#include "ros/small_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace frontalis
{
namespace
{

/// A demo with the phases raise (1 s, ramp 0.4 s), relax (0.5 s, with a longer ramp) and knit (1 s, without a ramp).
Model with_demo()
{
  Model model = small_model();
  model.expressions.push_back({ "raise", { { 0, 0.8f } } });
  model.expressions.push_back({ "knit", { { 1, 0.5f } } });
  model.demo.push_back({ 0, 0.4, 1.0 });
  model.demo.push_back({ -1, 0.9, 0.5 });
  model.demo.push_back({ 1, 0.0, 1.0 });
  return model;
}

TEST(DemoPlayer, RampsAndHoldsEachPhase)
{
  const DemoPlayer demo(std::make_shared<const Model>(with_demo()));
  EXPECT_DOUBLE_EQ(demo.period(), 2.5);
  EXPECT_NEAR(demo.activation(0).at("raiser"), 0, 1e-6);
  EXPECT_NEAR(demo.activation(0.2).at("raiser"), 0.4, 1e-6);
  EXPECT_NEAR(demo.activation(0.4).at("raiser"), 0.8, 1e-6);
  EXPECT_NEAR(demo.activation(0.99).at("raiser"), 0.8, 1e-6);
  EXPECT_EQ(demo.activation(0.5).at("knitter"), 0);
}

TEST(DemoPlayer, CutsARampToItsPhase)
{
  const DemoPlayer demo(std::make_shared<const Model>(with_demo()));
  EXPECT_NEAR(demo.activation(1.25).at("raiser"), 0.4, 1e-6);
  EXPECT_NEAR(demo.activation(1.5).at("raiser"), 0, 1e-6);
  EXPECT_NEAR(demo.activation(1.5).at("knitter"), 0.5, 1e-6);
}

TEST(DemoPlayer, RepeatsFromWhereTheLastPhaseEnded)
{
  const DemoPlayer demo(std::make_shared<const Model>(with_demo()));
  const auto later = demo.activation(2.5 * 4 + 0.2);
  EXPECT_NEAR(later.at("raiser"), 0.4, 1e-6);
  EXPECT_NEAR(later.at("knitter"), 0.25, 1e-6);
  EXPECT_NEAR(demo.activation(2.5 * 4 + 0.7).at("knitter"), 0, 1e-6);
}

TEST(DemoPlayer, NamesTheExpression)
{
  const DemoPlayer demo(std::make_shared<const Model>(with_demo()));
  for (const double round : { 0.0, 2.5, 5.0 })
  {
    EXPECT_EQ(demo.expression(round + 0.01), "raise");
    EXPECT_EQ(demo.expression(round + 0.99), "raise");
    EXPECT_EQ(demo.expression(round + 1.01), "relax");
    EXPECT_EQ(demo.expression(round + 2.49), "knit");
  }
  EXPECT_EQ(demo.expression(-1), "raise");
  EXPECT_EQ(DemoPlayer(std::make_shared<const Model>(small_model())).expression(1), "");
}

TEST(DemoPlayer, MovesBones)
{
  Model model = with_demo();
  model.bones = { "jaw", "finger" };
  model.demo[0].bones = { { 1, { { 0.01, 0, 0 } }, {} } };
  model.demo[1].bones = { { 1, {}, { { 0, 0, 0.5 } } } };
  model.demo[2].bones = { { 1, { { 0, 0, 0.02 } }, {} } };
  model.demo[2].expression = -2;
  const DemoPlayer demo(std::make_shared<const Model>(model));
  EXPECT_EQ(demo.bones(0.2).count("jaw"), 0u);
  EXPECT_NEAR(demo.bones(0.2).at("finger").translation[0], 0.005, 1e-12);
  // half of the rotation about z of the face frame is done; the next phase has no rotation
  EXPECT_NEAR(demo.bones(1.25).at("finger").rotation[3], std::sin(0.25), 1e-12);
  EXPECT_NEAR(demo.bones(1.5).at("finger").rotation[3], 0, 1e-12);
  // a phase without an expression keeps the previous expression
  EXPECT_NEAR(demo.bones(1.6).at("finger").translation[2], 0.02, 1e-12);
  EXPECT_NEAR(demo.activation(1.6).at("knitter"), 0, 1e-12);
  // the next round begins at the pose where the last one ended
  EXPECT_NEAR(demo.bones(2.7).at("finger").translation[2], 0.01, 1e-12);
}

TEST(DemoPlayer, IsEmptyWithoutPhases)
{
  const DemoPlayer demo(std::make_shared<const Model>(small_model()));
  EXPECT_TRUE(demo.empty());
  EXPECT_TRUE(demo.activation(1).empty());
  EXPECT_FALSE(DemoPlayer(std::make_shared<const Model>(with_demo())).empty());
}

}  // namespace
}  // namespace frontalis
