#include "frontalis/solver/rigid_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace frontalis;

namespace
{

RigidTransform turn_about_z(double angle, double x)
{
  RigidTransform pose;
  pose.rotation = { { std::cos(angle), -std::sin(angle), 0, std::sin(angle), std::cos(angle), 0, 0, 0, 1 } };
  pose.translation = { { x, 0, 0 } };
  return pose;
}

void expect_same(const RigidTransform& a, const RigidTransform& b)
{
  for (int i = 0; i < 9; ++i)
    EXPECT_NEAR(a.rotation[i], b.rotation[i], 1e-12);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(a.translation[i], b.translation[i], 1e-12);
}

}  // namespace

TEST(Interpolate, TurnsAboutTheShortestAxis)
{
  const RigidTransform from = turn_about_z(0.2, 1), to = turn_about_z(1.0, 3);
  expect_same(interpolate(from, to, 0), from);
  expect_same(interpolate(from, to, 1), to);
  const RigidTransform between = interpolate(from, to, 0.25), turned = turn_about_z(0.4, 0);
  for (int i = 0; i < 9; ++i)
    EXPECT_NEAR(between.rotation[i], turned.rotation[i], 1e-12);
}

TEST(Interpolate, APointThatABoneTurnsAboutStaysAndTheShiftAlongTheAxisIsScaled)
{
  // A rotation by 0.6 rad about the point (5, -2), with a shift of 0.8 along the axis.
  RigidTransform to = turn_about_z(0.6, 0);
  to.translation = { { 5 - (5 * std::cos(0.6) + 2 * std::sin(0.6)), -2 - (5 * std::sin(0.6) - 2 * std::cos(0.6)),
                       0.8 } };
  for (const double fraction : { 0.1, 0.5, 0.9 })
  {
    const auto p = interpolate(RigidTransform(), to, fraction)(std::array<double, 3>{ { 5, -2, 0 } });
    EXPECT_NEAR(p[0], 5, 1e-12);
    EXPECT_NEAR(p[1], -2, 1e-12);
    EXPECT_NEAR(p[2], 0.8 * fraction, 1e-12);
    // Half of the remaining motion ends at a pose of the whole motion.
    expect_same(interpolate(interpolate(RigidTransform(), to, fraction), to, 0.5),
                interpolate(RigidTransform(), to, 0.5 + 0.5 * fraction));
  }
}

TEST(Interpolate, ReachesTheTargetAtAnyAngle)
{
  const double pi = std::acos(-1.0);
  for (const double angle : { 0.0, 1e-10, 3.0, 3.0001, pi - 1e-6, pi - 1e-10, pi, pi + 1e-10, -3.1 })
  {
    RigidTransform to = turn_about_z(angle, 0);
    to.translation = { { 1, 2, 3 } };
    expect_same(interpolate(RigidTransform(), to, 1), to);
    const RigidTransform half = interpolate(RigidTransform(), to, 0.5);
    expect_same(interpolate(RigidTransform(), half, 0.5), interpolate(RigidTransform(), to, 0.25));
  }
}

TEST(Interpolate, HalfATurnAndNone)
{
  const double pi = std::acos(-1.0);
  const RigidTransform half = interpolate(turn_about_z(0, 0), turn_about_z(pi, 0), 0.5);
  EXPECT_NEAR(std::abs(half.rotation[1]), 1, 1e-9);
  EXPECT_NEAR(half.rotation[8], 1, 1e-9);
  expect_same(interpolate(turn_about_z(0.3, 0), turn_about_z(0.3, 0), 0.5), turn_about_z(0.3, 0));
}
