// `frontalis calibrate` finds the gains and the modulus of a robot's face from babbled poses.

#include "cli/program.hpp"

#include "frontalis/model/model_file.hpp"
#include "frontalis/runner/face_frame.hpp"
#include "frontalis/runner/named_controls.hpp"
#include "frontalis/solver/guard.hpp"
#include "frontalis/solver/rigid_motion.hpp"

#include <fmt/format.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace frontalis
{
namespace
{

const std::string directory = FRONTALIS_SOURCE_DIRECTORY;
// coarse voxels, so that a pose takes a fraction of a second
const std::vector<std::string> coarse{ "--voxel", "6" };

// A robot whose skin is 10 % stiffer than its scene says, and whose actuators move 10 % too far or too little.
constexpr double stiffness = 1.1;
constexpr std::array<double, 7> gains{ { 1.1, 0.9, 1.1, 0.9, 1.1, 0.9, 1.1 } };
// limits of the joints [m, rad], and the motion of their anchors: bone, axis (r: a turn about x), sign
struct Joint
{
  std::string name, bone;
  char axis = 'z';
  double sign = 1, lower = -0.004, upper = 0.008;
};
const std::array<double, 3> turned_about{ { 0, 0.02, 0.03 } };  // [m]
const std::array<Joint, 7> joints{ { { "outer_left_lift", "anchor_outer_left" },
                                     { "inner_left_lift", "anchor_inner_left" },
                                     { "inner_left_knit", "anchor_inner_left", 'y', -1, -0.002, 0.004 },
                                     { "outer_right_lift", "anchor_outer_right" },
                                     { "inner_right_lift", "anchor_inner_right" },
                                     { "inner_right_knit", "anchor_inner_right", 'y', 1, -0.002, 0.004 },
                                     { "outer_left_turn", "anchor_outer_left", 'r', 1, -0.2, 0.3 } } };
constexpr int poses = 12;

class Calibrate : public testing::Test
{
protected:
  std::string bake(const std::string& scene, const std::string& name)
  {
    std::vector<std::string> arguments{ "bake", scene, "-o", folder / name };
    arguments.insert(arguments.end(), coarse.begin(), coarse.end());
    const auto result = run_program(arguments);
    EXPECT_EQ(result.code, 0) << result.errors;
    return folder / name;
  }

  // the robot's motor babbling: tables of joints and of landmarks
  void record()
  {
    std::string scene = text_of(directory + "/test/cli/robot_brow.yaml");
    scene.replace(scene.find("young: 69 kPa"), 13, fmt::format("young: {} kPa", 69 * stiffness));
    const auto robot =
        std::make_shared<const Model>(read_model(bake(folder.write("robot.yaml", scene), "robot.vtkhdf")));
    SolverSettings settings;
    settings.threads = 1;
    const auto solver = make_solver(robot, settings);
    Guard guard(*solver, robot);
    SkinState rest, skin;
    solver->skin(rest);
    to_face_frame(*robot, rest);
    std::string positions = "time_s", landmarks = "time_s,landmark,forward_mm,left_mm,up_mm\n";
    for (const Joint& joint : joints)
      positions += fmt::format(",{0},{0}.effort", joint.name);
    std::mt19937 chance(1);
    for (int pose = 0; pose < poses; ++pose)
    {
      std::array<double, joints.size()> position{};
      std::map<std::string, double> moved;
      double angle = 0;
      for (std::size_t j = 0; j < joints.size(); ++j)
      {
        const double share = static_cast<double>(chance()) / static_cast<double>(std::mt19937::max());
        position[j] = joints[j].lower + share * (joints[j].upper - joints[j].lower);
        if (joints[j].axis == 'r')
          angle = gains[j] * position[j];
        else
          moved[joints[j].bone + "." + joints[j].axis] += 1e3 * gains[j] * joints[j].sign * position[j];
      }
      // the turn follows the lift
      Controls controls = value_controls(*robot, moved);
      const auto turned =
          std::find(robot->bones.begin(), robot->bones.end(), joints.back().bone) - robot->bones.begin();
      const RigidTransform lifted = motion_in_face(*robot, controls.bone[static_cast<std::size_t>(turned)]);
      const std::array<double, 3> before{ { -turned_about[0], -turned_about[1], -turned_about[2] } };
      const RigidTransform turn = composed(rigid_motion({ angle, 0, 0 }, turned_about), rigid_motion({}, before));
      set_bone_motion(*robot, joints.back().bone, composed(turn, lifted), controls.bone);
      solver->reset();
      guard.restart();
      ASSERT_TRUE(guard.settle(controls, 1e-3, 5).reached);
      solver->skin(skin);
      to_face_frame(*robot, skin);
      const auto bones = bones_in_face_frame(*solver, *robot, true);
      positions += fmt::format("\n{}", pose);
      for (std::size_t j = 0; j < joints.size(); ++j)
      {
        const auto bone = std::find(robot->bones.begin(), robot->bones.end(), joints[j].bone) - robot->bones.begin();
        const auto& [reaction, pose_of_bone] = bones[static_cast<std::size_t>(bone)];
        // forces along the axis of a joint, which turns with the bone that it carries
        const auto force = inverse(RigidTransform{ pose_of_bone.rotation, {} }).turned(reaction.force);
        double effort = joints[j].sign * double(force[joints[j].axis == 'y' ? 1 : 2]);
        if (joints[j].axis == 'r')
        {
          const auto& at = pose_of_bone.translation;  // the point to which the moment refers
          effort = double(reaction.moment[0]) + (at[1] - turned_about[1]) * double(reaction.force[2]) -
                   (at[2] - turned_about[2]) * double(reaction.force[1]);
        }
        positions += fmt::format(",{},{}", position[j], -effort);
      }
      for (std::size_t l = 0; l < robot->landmarks.size(); ++l)
        landmarks += fmt::format(
            "{},{},{},{},{}\n", pose, robot->landmarks[l], 1e3 * (skin.landmarks[l][0] - rest.landmarks[l][0]),
            1e3 * (skin.landmarks[l][1] - rest.landmarks[l][1]), 1e3 * (skin.landmarks[l][2] - rest.landmarks[l][2]));
    }
    folder.write("joints.csv", positions + "\n");
    folder.write("landmarks.csv", landmarks);
  }

  ProgramResult calibrate(const std::string& model, const std::string& actuators)
  {
    return run_program({ "calibrate", model, folder / "joints.csv", folder / "landmarks.csv", "--actuators", actuators,
                         "--threads", "1", "-o", folder / "found.yaml" });
  }

  TemporaryFolder folder;
};

TEST_F(Calibrate, finds_gains_and_modulus_of_a_robots_face)
{
  ASSERT_NO_FATAL_FAILURE(record());
  const auto result = calibrate(bake(directory + "/test/cli/robot_brow.yaml", "scene.vtkhdf"),
                                directory + "/test/cli/robot_brow_actuators.yaml");
  ASSERT_EQ(result.code, 0) << result.errors;
  const std::string text = text_of(folder / "found.yaml");
  const auto found = [&](const std::string& key)
  {
    const std::size_t at = text.find(key + ": ");
    EXPECT_NE(at, std::string::npos) << key;
    return std::stod(text.substr(at + key.size() + 2));
  };
  EXPECT_EQ(found("poses"), 9);
  EXPECT_EQ(found("\nheld_out"), 3);
  EXPECT_LE(found("held_out_error"), 0.02) << text;
  // the injected errors must show before, and be gone afterwards
  EXPECT_GT(found("error_before"), 10 * found("held_out_error")) << text;
  EXPECT_NEAR(found("modulus"), stiffness, 0.02) << text;
  for (const Joint& joint : joints)
  {
    const double gain = gains[static_cast<std::size_t>(&joint - joints.data())];
    if (joint.axis == 'r')
      EXPECT_NEAR(found(joint.name + ": {" + joint.bone + ".rx"), gain * 180 / 3.14159265, 1) << text;
    else
      EXPECT_NEAR(found(joint.name + ": {" + joint.bone + "." + joint.axis), 1e3 * joint.sign * gain, 20) << text;
  }
}

TEST_F(Calibrate, names_what_does_not_fit)
{
  const std::string model = bake(directory + "/test/cli/robot_brow.yaml", "scene.vtkhdf");
  folder.write("landmarks.csv", "time_s,landmark,forward_mm,left_mm,up_mm\n0,glabella,0,0,1\n");
  const auto refused = [&](const std::string& track, const std::string& actuators, const std::string& why)
  {
    folder.write("joints.csv", track);
    const auto result = calibrate(model, folder.write("actuators.yaml", actuators));
    EXPECT_EQ(result.code, 1);
    expect_contains(result.errors, why);
  };
  const std::string good = "actuators:\n  lift: {anchor_outer_left.z: 1000}\n";
  refused("time_s,lift\n0,0.001\n", "lift: 3\n", "has no actuators");
  refused("time_s,lift\n0,0.001\n", "actuators:\n  lift: 3\n", "actuators.yaml:2: ");
  refused("time_s,knit\n0,0.001\n", good, "joints.csv:1: has no column lift; the columns are time_s, knit");
  refused("time_s,lift\n0,0\n", good, "actuator lift never leaves 0");
  refused("time_s,lift\n1,0.001\n", good, "actuators at 1 s, but landmarks at 0 s");
  refused("time_s,lift\n0,0.001\n", "actuators:\n  lift: {nose.z: 1}\n", "nose");
  refused("time_s,lift\n0,0.001\n", "actuators:\n  lift: {nose.w: 1}\n", "actuators.yaml:2: 'nose.w' is no bone's .x");
  refused("time_s,a,b\n0,1,1\n", "actuators:\n  a: {nose.rx: 1}\n  b: {nose.ry: 1, about: [0, 0, 1]}\n",
          "a and b turn nose about different points");
}

}  // namespace
}  // namespace frontalis
