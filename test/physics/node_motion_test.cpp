// Work on a node in one step.

#include "frontalis/physics/element/node_motion.hpp"

#include <gtest/gtest.h>

namespace frontalis
{
namespace physics
{
namespace
{

TEST(NodeWork, of_damping_is_that_of_the_velocity_which_a_constraint_imposes)
{
  const double speed = 0.3, damping = 40, kick = 1e-3, half = 0.5 * damping * kick;
  const double free = kept_velocity(half) * speed;  // without the constraint and other forces
  const NodeWork work = node_work(speed, free, speed, 0, 0, damping, kick);
  EXPECT_NEAR(work.damping, damping * kick * speed * speed, 1e-15);
  EXPECT_NEAR(work.constraint, work.damping, 1e-15) << "the constraint replaces what damping takes";
}

}  // namespace
}  // namespace physics
}  // namespace frontalis
