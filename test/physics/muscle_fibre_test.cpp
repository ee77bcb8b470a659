#include "frontalis/physics/element/fibres.hpp"
#include "physics/deformation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace frontalis::physics;

TEST(MuscleFibre, ActiveTensionIsContinuousAndPeaksAtTheOptimalLength)
{
  EXPECT_DOUBLE_EQ(active_tension(1.0), 1.0);
  EXPECT_DOUBLE_EQ(active_tension(0.4), 0.0);
  EXPECT_DOUBLE_EQ(active_tension(1.6), 0.0);
  EXPECT_DOUBLE_EQ(active_tension(0.2), 0.0);
  EXPECT_DOUBLE_EQ(active_tension(2.0), 0.0);
  for (const double joint : { 0.4, 0.6, 1.4, 1.6 })
    EXPECT_NEAR(active_tension(joint - 1e-9), active_tension(joint + 1e-9), 1e-7) << joint;
}

TEST(MuscleFibre, PassiveTensionStartsAtOneAndGoesOnSmoothly)
{
  EXPECT_DOUBLE_EQ(passive_tension(0.8), 0.0);
  EXPECT_DOUBLE_EQ(passive_tension(1.0), 0.0);
  EXPECT_NEAR(passive_tension(1.2), 0.05 * (std::exp(6.6 * 0.2) - 1), 1e-12);
  const double step = 1e-6;
  const double before = (passive_tension(1.4) - passive_tension(1.4 - step)) / step;
  const double after = (passive_tension(1.4 + step) - passive_tension(1.4)) / step;
  EXPECT_NEAR(before, after, 1e-3);
  EXPECT_NEAR(passive_tension(3.0) - passive_tension(2.0), after, 1e-4);
}

TEST(MuscleFibre, SecondPiolaStressOfTheNominalStress)
{
  const double stretch = 0.9, reference = 0.3e6, activation = 0.6;
  const double S = fibre_stress(stretch * stretch, reference, activation, 1.0, 0.0);
  EXPECT_NEAR(S * stretch, reference * activation * active_tension(stretch), 1e-6);
  EXPECT_DOUBLE_EQ(fibre_stress(stretch * stretch, reference, activation, 0.0, 0.0), reference * activation);
}

// The fibre's stress does work along the sides of a square in the space of its stretch and the stretch across it.
TEST(MuscleFibre, DoesNoWorkInACycleOfStretchAndVolume)
{
  const double corner[][2] = { { 0.7, 0.8 }, { 1.3, 0.8 }, { 1.3, 1.2 }, { 0.7, 1.2 }, { 0.7, 0.8 } };
  const Fibre<double, double> fibre{ { 1, 0, 0 }, 1, 0.8, 1, true };
  const int steps = 1000;
  double work = 0, most = 0;
  for (int side = 0; side < 4; ++side)
    for (int i = 0; i < steps; ++i)
    {
      const auto stretch = [&](int axis, double at)
      { return corner[side][axis] + at / steps * (corner[side + 1][axis] - corner[side][axis]); };
      const test::Matrix F = test::diagonal(stretch(0, i + 0.5), stretch(1, i + 0.5), 1);
      const auto state = fibre_state(fibre, test::kinematics_of(F));
      work += state.stress * state.along[0] * (stretch(0, i + 1) - stretch(0, i));
      most = std::max(most, std::abs(work));
    }
  EXPECT_GT(most, 0.1);
  EXPECT_NEAR(work, 0, 1e-4 * most);
}

TEST(MuscleFibre, SlopeBoundsOfTheNominalStressHoldAndAreReached)
{
  const double step = 1e-4;
  double active = 0, passive = 0;
  for (double l = 0.3; l < 2; l += step)
  {
    const auto nominal = [&](double stretch, double activation, double with_passive)
    { return stretch * fibre_stress(stretch * stretch, 1.0, activation, 1.0, with_passive); };
    active = std::max(active, (nominal(l + step, 1, 0) - nominal(l, 1, 0)) / step);
    passive = std::max(passive, (nominal(l + step, 0, 1) - nominal(l, 0, 1)) / step);
  }
  EXPECT_LE(active, active_slope_bound + 1e-6);
  EXPECT_GE(active, 0.99 * active_slope_bound);
  EXPECT_LE(passive, passive_slope_bound);
  EXPECT_GE(passive, 0.99 * passive_slope_bound);
}

TEST(MuscleFibre, IsLessStiffAcrossThanTheTimeStepAllowsFor)
{
  for (double l = 0.1; l < 10; l += 1e-3)
    for (const double passive : { 0.0, 1.0 })
      EXPECT_LE(fibre_stress(l * l, 1.0, 1.0, 1.0, passive), active_slope_bound + passive * passive_slope_bound) << l;
}

TEST(MuscleFibre, FiniteForAnyStretch)
{
  for (const double squared : { 0.0, 1e-9, 4.0 })
    EXPECT_TRUE(std::isfinite(fibre_stress(squared, 1e6, 1.0, 1.0, 1.0)));
}
