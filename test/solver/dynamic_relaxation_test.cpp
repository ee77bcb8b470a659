#include "solver/stepping/dynamic_relaxation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace frontalis;

namespace
{

// Independent masses on springs, displaced from rest. The first one is the slowest.
struct Oscillators
{
  std::vector<double> mass{ 2, 1, 0.5 };
  std::vector<double> stiffness{ 2 * 100, 1 * 400, 0.5 * 2500 };  // frequencies 10, 20, 50 [1/s]
  std::vector<double> pull{ 20, 4, 2 };
  std::vector<double> u{ 0, 0, 0 }, v{ 0, 0, 0 };
  double time = 0;

  void advance(int steps, double damping)
  {
    constexpr double dt = 1e-3;
    for (int i = 0; i < steps; ++i, time += dt)
      for (std::size_t n = 0; n < u.size(); ++n)
      {
        v[n] += dt * ((pull[n] - stiffness[n] * u[n]) / mass[n] - damping * v[n]);
        u[n] += dt * v[n];
      }
  }
  NodalVectors displacements() const
  {
    NodalVectors out;
    for (const double x : u)
      out.push_back({ { 0, x, 0 } });
    return out;
  }
  void forces(NodalVectors& out) const
  {
    out.clear();
    for (std::size_t n = 0; n < u.size(); ++n)
      out.push_back({ { 0, stiffness[n] * u[n], 0 } });
  }
  // Distance from equilibrium divided by the displacement, in mass-weighted norms.
  double left() const
  {
    double apart = 0, there = 0;
    for (std::size_t n = 0; n < u.size(); ++n)
    {
      apart += mass[n] * std::pow(u[n] - pull[n] / stiffness[n], 2);
      there += mass[n] * u[n] * u[n];
    }
    return std::sqrt(apart / there);
  }
};

// Runs the motion to rest. Returns the number of calls of observe(), or 0 if the motion does not come to rest.
int settle(Oscillators& motion, double tolerance, DynamicRelaxation& relaxation, int steps_per_observation)
{
  for (int looks = 1; looks < 5000; ++looks)
  {
    motion.advance(steps_per_observation, relaxation.damping());
    NodalVectors u = motion.displacements();
    relaxation.observe(
        motion.time, u, [&](NodalVectors& out) { motion.forces(out); }, 500, false);
    if (relaxation.result().reached)
    {
      EXPECT_LE(relaxation.result().residual, tolerance);
      return looks;
    }
  }
  return 0;
}

DynamicRelaxation of(const Oscillators& motion, double tolerance)
{
  NodalVectors f;
  motion.forces(f);
  return { { tolerance, 0, 64 }, motion.mass, motion.time, motion.displacements(), f };
}

}  // namespace

TEST(DynamicRelaxation, damps_the_slowest_motion_critically)
{
  Oscillators motion;
  DynamicRelaxation relaxation = of(motion, 1e-3);
  EXPECT_EQ(relaxation.damping(), 0);
  ASSERT_GT(settle(motion, 1e-3, relaxation, 20), 0);
  EXPECT_NEAR(relaxation.damping(), 2 * 10, 2) << "twice the lowest frequency";
}

TEST(DynamicRelaxation, says_how_far_the_motion_still_is_from_rest)
{
  for (const double tolerance : { 1e-2, 1e-3, 1e-4 })
  {
    Oscillators motion;
    DynamicRelaxation relaxation = of(motion, tolerance);
    ASSERT_GT(settle(motion, tolerance, relaxation, 20), 0);
    EXPECT_LT(motion.left(), 2 * tolerance);
    EXPECT_DOUBLE_EQ(relaxation.result().seconds, motion.time);
  }
}

TEST(DynamicRelaxation, begins_whenever_it_is_made)
{
  Oscillators motion;
  motion.time = 7;
  DynamicRelaxation relaxation = of(motion, 1e-3);
  ASSERT_GT(settle(motion, 1e-3, relaxation, 20), 0);
  EXPECT_NEAR(relaxation.result().seconds, motion.time - 7, 1e-12);
}

TEST(DynamicRelaxation, is_not_deceived_by_a_motion_that_has_hardly_begun)
{
  Oscillators motion;
  DynamicRelaxation relaxation = of(motion, 0.5);
  ASSERT_GT(settle(motion, 0.5, relaxation, 1), 0);
  EXPECT_GT(motion.time, 0.3) << "four radians of the slowest, which it sees as somewhat faster at first";
}

TEST(DynamicRelaxation, is_at_rest_where_nothing_moves)
{
  Oscillators motion;
  motion.pull = { 0, 0, 0 };
  DynamicRelaxation relaxation = of(motion, 1e-3);
  EXPECT_EQ(settle(motion, 1e-3, relaxation, 20), 4);
  EXPECT_EQ(relaxation.result().residual, 0);
}

TEST(DynamicRelaxation, does_not_damp_above_what_is_allowed)
{
  Oscillators motion;
  DynamicRelaxation relaxation = of(motion, 1e-3);
  motion.advance(20, 0);
  NodalVectors u = motion.displacements();
  relaxation.observe(
      motion.time, u, [&](NodalVectors& out) { motion.forces(out); }, 3, false);
  EXPECT_EQ(relaxation.damping(), 3);
}

// A window ends when the change exceeds rounding errors, after a number of calls of observe(), or at the end of the
// motion.
TEST(DynamicRelaxation, asks_for_forces_at_the_end_of_windows_alone)
{
  for (const bool last : { false, true })
  {
    Oscillators motion;
    motion.advance(2000, 20);
    DynamicRelaxation relaxation = of(motion, 1e-9);
    int asked = 0;
    for (int look = 1; look <= 64; ++look)
    {
      motion.time += 1e-3;  // time passes, but the masses do not move
      NodalVectors u = motion.displacements();
      const auto forces = [&](NodalVectors& out)
      {
        ++asked;
        motion.forces(out);
      };
      relaxation.observe(motion.time, u, forces, 500, last && look == 10);
      EXPECT_EQ(asked, (last && look >= 10 ? 1 : 0) + (!last && look == 64 ? 1 : 0)) << look;
    }
  }
}
