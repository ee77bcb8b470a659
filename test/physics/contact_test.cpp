// Friction of a point on a body: what its spring stores is what moving the point has cost.

#include "frontalis/physics/contact.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace physics
{
namespace
{

using Vector = Vec3<double>;

constexpr double radius = 4e-3, stiffness = 100;

// A sphere about the origin.
FieldValue<double> sphere_at(const Vector& x)
{
  const double distance = norm(x);
  FieldValue<double> value{};
  value.value = distance - radius;
  value.gradient = (1 / distance) * x;
  return value;
}

// A point that sticks sinks deeper, goes along the sphere, rises and comes back.
TEST(Friction, of_a_point_that_sticks_creates_no_energy_as_the_normal_turns)
{
  constexpr int steps = 2000;
  const auto place = [](double depth, double angle) {
    return (radius - depth) * Vector{ std::sin(angle), 0, std::cos(angle) };
  };
  const double corners[5][2] = { { 0.2e-3, 0 }, { 0.5e-3, 0 }, { 0.5e-3, 0.2 }, { 0.2e-3, 0.2 }, { 0.2e-3, 0 } };
  Vector x = place(corners[0][0], corners[0][1]);
  Grip<double> grip{ x, 0, 0 };
  auto now = touch<double>(sphere_at(x), x, grip, stiffness, 1e3, 1);
  const double initial = now.stored;
  double work = 0, most = initial;
  for (int side = 0; side < 4; ++side)
    for (int step = 1; step <= steps; ++step)
    {
      const double share = double(step) / steps;
      const Vector to = place(corners[side][0] + share * (corners[side + 1][0] - corners[side][0]),
                              corners[side][1] + share * (corners[side + 1][1] - corners[side][1]));
      const auto next = touch<double>(sphere_at(to), to, now.grip, stiffness, 1e3, 1);
      EXPECT_EQ(next.lost, 0) << "it sticks";
      work -= dot(0.5 * (now.force + next.force), to - x);
      x = to;
      now = next;
      most = std::max(most, now.stored);
    }
  EXPECT_NEAR(now.stored - initial, work, 1e-3 * most);
  EXPECT_GT(now.stored, initial) << "it has come back along a longer way than it went";
}

TEST(Friction, of_a_point_that_rests_has_an_anchor_that_rests)
{
  const Vec3<float> x{ 1.1e-3F, 0.7e-3F, 3.6e-3F };
  const float distance = norm(x);
  FieldValue<float> value{};
  value.value = distance - 4e-3F;
  value.gradient = (1 / distance) * x;
  Grip<float> grip{ { 1.2e-3F, 0.6e-3F, 3.7e-3F }, 0, 0 };
  for (int step = 0; step < 10; ++step)
    grip = touch<float>(value, x, grip, 100, 1e3F, 1).grip;
  const Vec3<float> settled = grip.anchor;
  for (int step = 0; step < 100000; ++step)
    grip = touch<float>(value, x, grip, 100, 1e3F, 1).grip;
  EXPECT_LT(norm(grip.anchor - settled), 1e-8F);
}

}  // namespace
}  // namespace physics
}  // namespace frontalis
