// Action units in a file that several scenes share.

#include "frontalis/error.hpp"
#include "frontalis/scene/read_scene.hpp"
#include "files.hpp"

#include <gtest/gtest.h>

#include <map>
#include <string>

namespace frontalis
{
namespace
{

// A file that scenes share may name muscles that a scene lacks. A muscle without a side means both sides.
TEST(SharedActionUnits, what_the_scene_lacks_is_left_out)
{
  const TemporaryFolder folder;
  folder.write("units.yaml",
               "unit: mm\n"
               "action_units:\n"
               "  AU1: {pull: 1, absent: 1}\n"
               "  AU2: {absent: 1}\n"
               "  AU26: {bones: {jaw: {shift: [0, 0, -2]}, tail: {shift: [1, 0, 0]}}}\n"
               "expressions:\n"
               "  up: {AU1: 0.5, AU2: 1}\n"
               "  down: {AU2: 1}\n"
               "  mine: {AU1: 1}\n");
  const std::string scene_text =
      "unit: mm\n"
      "surfaces: {bar: {shape: box, size: [30, 10, 10]}, wall: {shape: box, centre: [-16, 0, 0], size: [2, 14, 14]}}\n"
      "volumes: {bar: {inside: bar, material: flesh, tissue: true}}\n"
      "materials: {flesh: {young: 34 kPa, poisson: 0.49, density: 1000}}\n"
      "muscles: {pull_left: {volume: bar, fibre: [1, 0, 0]}, pull_right: {volume: bar, fibre: [1, 0, 0]}}\n"
      "constraints: [{name: hold, rigid: wall, bone: jaw}]\n"
      "skin: {surface: bar}\n"
      "action_units: units.yaml\n"
      "expressions: {mine: {pull_left: 0.25}}\n";
  const Scene scene = read_scene(folder.write("scene.yaml", scene_text));
  ASSERT_EQ(scene.action_units.size(), 2U);
  EXPECT_EQ(scene.action_units.at("AU1").activation,
            (std::map<std::string, double>{ { "pull_left", 1 }, { "pull_right", 1 } }));
  ASSERT_EQ(scene.action_units.at("AU26").bones.size(), 1U);
  ASSERT_EQ(scene.expressions.size(), 2U);
  EXPECT_EQ(scene.expressions.at("up").activation.at("pull_right"), 0.5);
  EXPECT_EQ(scene.expressions.at("mine").activation, (std::map<std::string, double>{ { "pull_left", 0.25 } }));

  folder.write("units.yaml", "unit: mm\naction_units:\n  AU1: {pull: 2}\n");
  try
  {
    read_scene(folder.write("scene.yaml", scene_text));
    FAIL() << "a weight of 2 is taken";
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("units.yaml:3: action_units.AU1.pull: found '2'; must be at least -1"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace frontalis
