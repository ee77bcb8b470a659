#include "frontalis/ros/demo_player.hpp"

#include "ros/small_model.hpp"

#include <gtest/gtest.h>

namespace frontalis
{
namespace
{

/// A demo: raise for 1 s with a ramp of 0.4 s, relax for 0.5 s with a longer ramp, knit for 1 s without a ramp.
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
  const DemoPlayer demo(with_demo());
  EXPECT_DOUBLE_EQ(demo.period(), 2.5);
  EXPECT_NEAR(demo.activation(0).at("raiser"), 0, 1e-6);
  EXPECT_NEAR(demo.activation(0.2).at("raiser"), 0.4, 1e-6);
  EXPECT_NEAR(demo.activation(0.4).at("raiser"), 0.8, 1e-6);
  EXPECT_NEAR(demo.activation(0.99).at("raiser"), 0.8, 1e-6);
  EXPECT_EQ(demo.activation(0.5).at("knitter"), 0);
}

TEST(DemoPlayer, CutsARampToItsPhase)
{
  const DemoPlayer demo(with_demo());
  EXPECT_NEAR(demo.activation(1.25).at("raiser"), 0.4, 1e-6);
  EXPECT_NEAR(demo.activation(1.5).at("raiser"), 0, 1e-6);
  EXPECT_NEAR(demo.activation(1.5).at("knitter"), 0.5, 1e-6);
}

TEST(DemoPlayer, RepeatsFromWhereTheLastPhaseEnded)
{
  const DemoPlayer demo(with_demo());
  const auto later = demo.activation(2.5 * 4 + 0.2);
  EXPECT_NEAR(later.at("raiser"), 0.4, 1e-6);
  EXPECT_NEAR(later.at("knitter"), 0.25, 1e-6);
  EXPECT_NEAR(demo.activation(2.5 * 4 + 0.7).at("knitter"), 0, 1e-6);
}

TEST(DemoPlayer, IsEmptyWithoutPhases)
{
  const DemoPlayer demo(small_model());
  EXPECT_TRUE(demo.empty());
  EXPECT_TRUE(demo.activation(1).empty());
  EXPECT_FALSE(DemoPlayer(with_demo()).empty());
}

}  // namespace
}  // namespace frontalis
