#include "solver/stepping/bone_motion_limits.hpp"

#include "block_model.hpp"
#include "frontalis/solver/rigid_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace frontalis;

namespace
{

constexpr double edge = 1e-3;
constexpr double speed = 0.5;  // [m/s]

using Poses = BoneMotionLimits::Poses;

Poses moved(double way) { return { rigid_motion({ { 0, 0, 0 } }, { { way, 0, 0 } }) }; }

}  // namespace

TEST(BoneMotionLimits, keep_bones_from_skipping_voxels)
{
  const Model model = test::block_model();
  const BoneMotionLimits limits(model);
  EXPECT_NEAR(limits.longest_step(moved(0), moved(speed), 1), 0.1 * edge / speed, 1e-9);
  EXPECT_TRUE(std::isinf(limits.longest_step(moved(speed), moved(speed), 1)));
  EXPECT_TRUE(std::isinf(limits.longest_step({}, {}, 1)));
  // A rotation moves the far corner along an arc.
  const Poses turned{ rigid_motion({ { 0, 0, 1 } }, { { 0, 0, 0 } }) };
  EXPECT_NEAR(limits.longest_step(moved(0), turned, 1), 0.1 * edge / (4e-3 * std::sqrt(2.0)), 1e-3);
}

TEST(BoneMotionLimits, notice_jumps_of_velocity)
{
  const Model model = test::block_model();
  BoneMotionLimits limits(model);
  // time step in which a bone with this speed moves by the limit, 0.5 % of a voxel [s]
  const double felt = 0.005 * edge / speed;
  EXPECT_TRUE(limits.jumps(moved(0), moved(speed), 1, 1.01 * felt)) << "it begins to move";
  EXPECT_FALSE(limits.jumps(moved(0), moved(speed), 1, 0.99 * felt));
  limits.moved(moved(0), 1);
  EXPECT_FALSE(limits.jumps(moved(speed), moved(1.5 * speed), 0.5, 100 * felt)) << "it goes on";
  EXPECT_TRUE(limits.jumps(moved(speed), moved(speed), 1, 1.01 * felt)) << "it stops";
  EXPECT_FALSE(limits.jumps(moved(speed), moved(speed), 1, 0.99 * felt));
  EXPECT_TRUE(limits.jumps(moved(speed), moved(0), 1, 0.51 * felt)) << "it turns back";
  EXPECT_FALSE(limits.jumps(moved(speed), moved(0), 0, 1)) << "no time passes";
}
