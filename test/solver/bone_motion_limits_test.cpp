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

// The block, whose upper end the bone holds.
Model held_block()
{
  Model model = test::block_model();
  model.bones = { "bone" };
  test::hold_plane(model, 2, 0, model.size[2]);
  return model;
}

double way_along_x(const Poses& poses) { return poses.at(0).translation[0]; }

}  // namespace

TEST(BoneMotionLimits, keep_bones_from_outrunning_tissue)
{
  const Model model = held_block();
  // at this critical step a bone may move with `speed`
  const BoneMotionLimits limits(model, 0.1 * edge / speed);
  EXPECT_NEAR(way_along_x(limits.reached(moved(0), moved(speed), 1)), speed, 1e-12) << "just slow enough";
  EXPECT_NEAR(way_along_x(limits.reached(moved(0), moved(3 * speed), 1)), speed, 1e-9);
  EXPECT_NEAR(way_along_x(limits.reached(moved(speed), moved(-speed), 0.5)), 0.5 * speed, 1e-9);
  EXPECT_EQ(way_along_x(limits.reached(moved(speed), moved(0), 0)), speed) << "no time passes";
  EXPECT_TRUE(limits.reached({}, {}, 1).empty());
}

TEST(BoneMotionLimits, count_the_tissue_that_a_bone_can_move)
{
  Model model = held_block();
  const BoneMotionLimits limits(model, 0.1 * edge / speed);
  const Poses turned{ rigid_motion({ { 0, 0, 1 } }, { { 0, 0, 0 } }) };
  // The farthest held node moves along an arc. It may take as long as `speed` needs for the arc.
  const double arc = std::hypot(model.size[0], model.size[1]) * edge;
  EXPECT_NEAR(limits.reached(moved(0), turned, 0.99 * arc / speed)[0].rotation[0], std::cos(0.99), 5e-3);
  EXPECT_EQ(limits.reached(moved(0), turned, 1.01 * arc / speed)[0].rotation, turned[0].rotation);
  // A bone that holds no tissue may go anywhere at once.
  model.rigid.clear();
  EXPECT_EQ(way_along_x(BoneMotionLimits(model, 1).reached(moved(0), moved(speed), 1e-9)), speed);
}

TEST(BoneMotionLimits, notice_jumps_of_velocity)
{
  const Model model = held_block();
  BoneMotionLimits limits(model, 1);
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

TEST(BoneMotionLimits, limit_the_length_of_a_plan)
{
  const BoneMotionLimits limits(held_block(), 1);
  EXPECT_NEAR(limits.longest_plan(moved(0), moved(2 * edge), 1), 0.25, 1e-12) << "half a voxel of two";
  EXPECT_TRUE(std::isinf(limits.longest_plan(moved(0), moved(0.4 * edge), 1)));
  EXPECT_TRUE(std::isinf(limits.longest_plan(moved(speed), moved(speed), 1)));
}
