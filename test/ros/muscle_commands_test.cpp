#include "frontalis/ros/blendshapes.hpp"
#include "frontalis/ros/muscle_commands.hpp"

#include "frontalis/error.hpp"
#include "ros/small_model.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace frontalis
{
namespace
{

MuscleCommands two_muscles() { return MuscleCommands(std::make_shared<const Model>(small_model())); }

TEST(MuscleCommands, HoldTheLatestOfEachMuscle)
{
  MuscleCommands commands = two_muscles();
  EXPECT_EQ(commands.at(1).at("raiser"), 0);
  commands.set({ { "raiser", 0.5 } }, 1);
  commands.set({ { "knitter", 0.25 } }, 2);
  EXPECT_EQ(commands.at(5).at("raiser"), 0.5);
  EXPECT_EQ(commands.at(5).at("knitter"), 0.25);
  EXPECT_FALSE(commands.moving(2));
  commands.clear();
  EXPECT_EQ(commands.at(5).at("raiser"), 0);
}

TEST(MuscleCommands, GoOnUntilALaterCourseBegins)
{
  MuscleCommands commands = two_muscles();
  commands.follow({ { "raiser", { { 0, 0 }, { 2, 1 } } } }, 0, 0);
  commands.follow({ { "raiser", { { 1, 0.5 }, { 3, 0 } } } }, 1, 0.5);
  EXPECT_DOUBLE_EQ(commands.at(0.75).at("raiser"), 0.375);
  EXPECT_DOUBLE_EQ(commands.at(2).at("raiser"), 0.25);
  EXPECT_TRUE(commands.moving(2.9));
  EXPECT_FALSE(commands.moving(3));
}

TEST(MuscleCommands, SilenceBeginsWithTheEndOfACourse)
{
  MuscleCommands commands = two_muscles();
  EXPECT_EQ(commands.silence(10), 0);
  commands.follow({ { "raiser", { { 0, 0 }, { 2, 1 } } } }, 0, 0);
  EXPECT_EQ(commands.silence(1), 0);
  EXPECT_DOUBLE_EQ(commands.silence(2.5), 0.5);
  commands.relax(2.5, 1);
  EXPECT_DOUBLE_EQ(commands.at(3).at("raiser"), 0.5);
  EXPECT_DOUBLE_EQ(commands.silence(3), 1);
  commands.set({ { "raiser", 1 } }, 3);
  EXPECT_EQ(commands.silence(3), 0);
}

TEST(MuscleCommands, SilenceBeginsWithTheLastEndOfCoursesAndMotionsOfBones)
{
  MuscleCommands commands = two_muscles();
  commands.follow({ { "raiser", { { 0, 0 }, { 2, 1 } } } }, 0, 0);
  commands.set({ { "knitter", 1 } }, 0.5);
  EXPECT_EQ(commands.silence(1.9), 0);
  EXPECT_DOUBLE_EQ(commands.silence(2.5), 0.5);
  commands.follow({}, 3, 3, 5);
  EXPECT_TRUE(commands.moving(4.9));
  EXPECT_FALSE(commands.moving(5));
  EXPECT_DOUBLE_EQ(commands.silence(6), 1);
}

TEST(MuscleCommands, RefuseAsAWhole)
{
  MuscleCommands commands = two_muscles();
  EXPECT_THROW(commands.set({ { "raiser", 0.5 }, { "nobody", 0.5 } }, 1), Error);
  EXPECT_THROW(commands.set({ { "raiser", 0.5 }, { "knitter", std::numeric_limits<double>::quiet_NaN() } }, 1), Error);
  EXPECT_THROW(commands.follow({ { "raiser", { { 1, 0.5 }, { 2, 1.5 } } } }, 1, 1), Error);
  EXPECT_EQ(commands.at(3).at("raiser"), 0);
}

TEST(Blendshapes, TableHasTheNamesOfFaceTrackers)
{
  Model model = small_model();
  model.muscles[0].name = "frontalis_left";
  model.muscles[1].name = "zygomaticus_major_right";
  model.muscles[0].tone = 0.1;
  model.bones = { "mandible" };
  model.action_units.push_back({ "AU27", {}, { { 0, {}, { { 0, 0.5, 0 } }, {} } } });
  const BlendshapeTable table(std::string(FRONTALIS_SOURCE_DIRECTORY) + "/config/blendshapes.yaml", model);
  EXPECT_EQ(table.size(), 52u);
  std::set<std::string> lacking;
  const auto pose =
      table.pose(model, { "browInnerUp", "mouthSmileRight", "jawOpen", "tongueOut" }, { 0.5, 1, 0.5, 1 }, lacking);
  EXPECT_FLOAT_EQ(pose.activation[0], 0.1f + 0.3f);
  EXPECT_GT(pose.activation[1], 0.5f);
  EXPECT_NE(pose.bone[0].rotation, RigidTransform().rotation);
  EXPECT_EQ(lacking, std::set<std::string>{ "tongueOut" });
}

}  // namespace
}  // namespace frontalis
