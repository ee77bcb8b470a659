#include "frontalis/physics/muscle_fibre.hpp"

#include <gtest/gtest.h>

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

TEST(MuscleFibre, SecondPiolaStressOfTheCauchyStress)
{
  // Cauchy stress sigma along the fibre is S stretch^2 / J
  const double stretch = 0.9, J = 0.98, reference = 0.3e6, activation = 0.6;
  const double S = fibre_stress(stretch * stretch, J, reference, activation, 1.0, 0.0);
  EXPECT_NEAR(S * stretch * stretch / J, reference * activation * active_tension(stretch) * stretch, 1e-6);
  EXPECT_DOUBLE_EQ(fibre_stress(stretch * stretch, J, reference, activation, 0.0, 0.0), reference * activation);
}

TEST(MuscleFibre, SlopeBoundsOfTheNominalStressHoldAndAreReached)
{
  const double step = 1e-4;
  double active = 0, passive = 0;
  for (double l = 0.3; l < 2; l += step)
  {
    const auto nominal = [&](double stretch, double activation, double with_passive)
    { return stretch * fibre_stress(stretch * stretch, 1.0, 1.0, activation, 1.0, with_passive); };
    active = std::max(active, (nominal(l + step, 1, 0) - nominal(l, 1, 0)) / step);
    passive = std::max(passive, (nominal(l + step, 0, 1) - nominal(l, 0, 1)) / step);
  }
  EXPECT_LE(active, active_slope_bound + 1e-6);
  EXPECT_GE(active, 0.99 * active_slope_bound);
  EXPECT_LE(passive, passive_slope_bound);
  EXPECT_GE(passive, 0.99 * passive_slope_bound);
}

TEST(MuscleFibre, FinitePastInversion)
{
  for (const double J : { 0.1, 0.0, -1.0 })
    for (const double squared : { 0.0, 1e-9, 4.0 })
      EXPECT_TRUE(std::isfinite(fibre_stress(squared, J, 1e6, 1.0, 1.0, 1.0)));
}
