#include "frontalis/physics/muscle_fibre.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

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
  // The Cauchy stress along the fibre is S stretch^2 / J.
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

// The stiffness here is the quadratic form of the second derivatives of J f(l) in dF, divided by |dF|^2, at full
// activation.
TEST(MuscleFibre, WhatTheTimeStepAllowsForHoldsForAnyStretchesUpToTwoAndAHalf)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> exponent(-1, 1);
  for (const bool passive : { false, true })
  {
    double worst = 0;
    for (int i = 0; i < 200000; ++i)
    {
      const double most = i % 2 == 0 ? 1.5 : 2.5;
      const double a = std::pow(most, exponent(random)), b = std::pow(most, exponent(random));
      const double c = i % 3 == 0 ? std::pow(most, exponent(random)) : 1 / (a * b);
      const double J = a * b * c, step = 1e-5;  // the fibre lies along a
      const auto f = [&](double l) { return active_tension(l) + (passive ? passive_tension(l) : 0); };
      const double slope = (f(a + step) - f(a - step)) / (2 * step);
      const double cofactor = std::sqrt(b * b * c * c + a * a * c * c + a * a * b * b);
      const double I1 = a * a + b * b + c * c;
      const double counted = std::max({ 1.0, J, std::sqrt(cofactor * cofactor / 3 * I1 / 3) });
      const double form = J * std::max(slope, f(a) / a) + 0.5 * f(a) * (cofactor + J / a);
      worst = std::max(worst, form / counted);
    }
    const double allowed = active_slope_bound + (passive ? passive_slope_bound : 0);
    EXPECT_LE(worst, allowed) << passive;
    EXPECT_GE(worst, 0.8 * allowed) << passive;
  }
}

TEST(MuscleFibre, FinitePastInversion)
{
  for (const double J : { 0.1, 0.0, -1.0 })
    for (const double squared : { 0.0, 1e-9, 4.0 })
      EXPECT_TRUE(std::isfinite(fibre_stress(squared, J, 1e6, 1.0, 1.0, 1.0)));
}
