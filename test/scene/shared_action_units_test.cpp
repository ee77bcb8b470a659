// Action units in a file that several scenes share.

#include "frontalis/error.hpp"
#include "frontalis/scene/read_scene.hpp"
#include "files.hpp"

#include <gtest/gtest.h>

#include <iterator>
#include <map>
#include <regex>
#include <set>
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
               "  AU4: {pull: 0.5}\n"
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
  ASSERT_EQ(scene.action_units.size(), 3U);
  EXPECT_EQ(std::next(scene.action_units.begin())->first, "AU4") << "numbers in names have their order";
  EXPECT_EQ(scene.action_units.at("AU1").activation,
            (std::map<std::string, double>{ { "pull_left", 1 }, { "pull_right", 1 } }));
  ASSERT_EQ(scene.action_units.at("AU26").bones.size(), 1U);
  ASSERT_EQ(scene.expressions.size(), 2U);
  EXPECT_EQ(scene.expressions.at("up").activation.at("pull_right"), 0.5);
  EXPECT_EQ(scene.expressions.at("mine").activation, (std::map<std::string, double>{ { "pull_left", 0.25 } }));

  const auto text_of_one_side = std::regex_replace(
      std::regex_replace(scene_text, std::regex(", pull_right: [^}]*\\}"), ""), std::regex("expressions.*\n"), "");
  const Scene one_sided = read_scene(folder.write("scene.yaml", text_of_one_side));
  EXPECT_EQ(one_sided.action_units.at("AU1").activation, (std::map<std::string, double>{ { "pull_left", 1 } }))
      << "a face may have one of two muscles";

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

// Forms of one side, such as smile_left, take the muscles and bones whose names end with that side, so that each needs
// a counterpart of the same weight.
TEST(SharedActionUnits, both_heads_have_the_same_expressions_and_both_sides_of_each)
{
  const std::set<std::string> wanted{
    "raise_brows", "frown",  "blink",           "squint",         "cheek_raise", "nose_wrinkle", "upper_lip_raise",
    "smile",       "pucker", "lip_corner_down", "lower_lip_down", "chin_raise",  "lip_stretch",  "lip_press",
    "jaw_open",    "puff",   "surprise",        "anger",          "sadness",     "fear",         "disgust",
    "joy"
  };
  for (const std::string name : { "head", "real_face" })
  {
    const std::string file = FRONTALIS_SOURCE_DIRECTORY "/config/" + name + ".yaml", text = text_of(file);
    // meshes that are not shipped need only exist for their scene to be read
    const TemporaryFolder meshes;
    const std::regex mesh("\\{file: ([^},]+)");
    for (std::sregex_iterator found(text.begin(), text.end(), mesh), end; found != end; ++found)
      meshes.write((*found)[1], "");
    SceneOptions options;
    if (name == "real_face")
      options.mesh_directory = meshes.path();
    const Scene scene = read_scene(file, options);
    std::set<std::string> found;
    for (const auto& [expression, pose] : scene.expressions)
    {
      found.insert(expression);
      EXPECT_FALSE(pose.activation.empty() && pose.bones.empty()) << name << ": " << expression;
      for (const auto& [muscle, weight] : pose.activation)
        if (const std::size_t side = muscle.rfind("_left"); side != std::string::npos)
        {
          const auto right = pose.activation.find(muscle.substr(0, side) + "_right");
          ASSERT_NE(right, pose.activation.end()) << name << ": " << expression << ": " << muscle;
          EXPECT_EQ(right->second, weight) << name << ": " << expression << ": " << muscle;
        }
    }
    EXPECT_EQ(found, wanted) << name;
  }
}

}  // namespace
}  // namespace frontalis
