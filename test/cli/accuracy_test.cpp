#include "cli/program.hpp"

#include <gtest/gtest.h>

#include <regex>

namespace frontalis
{
namespace
{

const char* const bar = R"(unit: mm
surfaces:
  bar: {shape: box, size: [10, 10, 30]}
  ceiling: {shape: box, centre: [0, 0, 16], size: [14, 14, 2]}
volumes:
  bar: {inside: bar, material: flesh, tissue: true}
materials:
  flesh: {young: 34 kPa, poisson: 0.45, density: 1000}
muscles:
  lift: {volume: bar, fibre: [0, 0, 1], stress_reference: 20 kPa}
constraints:
  - {name: hang, rigid: ceiling, within: 0.5}
skin: {surface: bar}
landmarks:
  tip: [0, 0, -15]
time: {damping: 60}
accuracy:
  standard: {voxel: 2.5}
expressions:
  shorten: {lift: 0.5}
)";

class AccuracyCommand : public testing::Test
{
protected:
  void SetUp() override { std::ofstream(scene) << bar; }

  ProgramResult run(std::vector<std::string> more) const
  {
    std::vector<std::string> all{ "accuracy", scene,       "--quick", "--knobs",  "voxel", "--voxels",
                                  "5,2.5,2",  "--threads", "1",       "--output", results };
    all.insert(all.end(), more.begin(), more.end());
    return run_program(all);
  }

  TemporaryFolder folder;
  std::string scene = folder / "bar.yaml";
  std::string results = folder / "results";
};

TEST_F(AccuracyCommand, measures_chooses_and_the_profile_can_be_used)
{
  const std::string chosen = folder / "chosen.yaml";
  const ProgramResult result = run({ "--tolerance", "5", "--save", chosen });
  ASSERT_EQ(result.code, 0) << result.errors << result.output;
  // The cheapest setting depends on the machine, so the choice is checked against the measured costs.
  nlohmann::json cheapest;
  for (const nlohmann::json& row : json_from(text_of(results + "/accuracy.json")))
    if (row.at("front") == "*" && row.at("error RMS [mm]") <= 5 &&
        (cheapest.is_null() || row.at("cost [s/s]") < cheapest.at("cost [s/s]")))
      cheapest = row;
  ASSERT_FALSE(cheapest.is_null()) << result.output;
  expect_contains(result.output, "chosen    " + cheapest.at("setting").get<std::string>() + ":");
  expect_contains(text_of(results + "/accuracy.csv"), "setting,front,error RMS [mm]");
  const std::string report = text_of(results + "/accuracy.md");
  expect_contains(report, "Its own error is about");
  expect_contains(report, "The motion is expression 'shorten', reached in 0.2 s");
  const ProgramResult baked = run_program({ "bake", scene, "--accuracy", chosen, "-o", folder / "bar.vtkhdf" });
  EXPECT_EQ(baked.code, 0) << baked.errors;
  const std::string edge = std::regex_replace(text_of(chosen), std::regex("(.|\n)*voxel: ([0-9.]+) mm(.|\n)*"), "$2");
  expect_contains(baked.output, "of " + edge + " x " + edge + " x " + edge + " mm");

  const ProgramResult again = run({ "--tolerance", "1e-6" });
  EXPECT_EQ(again.code, 1);
  expect_contains(again.errors, "nothing is claimed below it");
  const ProgramResult hasty = run({ "--time", "1e-9" });
  EXPECT_EQ(hasty.code, 1);
  expect_contains(hasty.errors, "the cheapest, ");
}

TEST_F(AccuracyCommand, refuses_what_cannot_be)
{
  const ProgramResult colour = run({ "--knobs", "colour" });
  EXPECT_EQ(colour.code, 1);
  expect_contains(colour.errors, "no knob is called 'colour'; the knobs are voxel, samples, fill_min");
  const ProgramResult stiff = run_program({ "accuracy", "cantilever", "--knobs", "poisson", "-o", results });
  EXPECT_EQ(stiff.code, 1);
  expect_contains(stiff.errors, "cantilever has no knob 'poisson'; its knobs are voxel, hourglass");
  EXPECT_EQ(run_program({ "accuracy", "cantilever", "--accuracy", "draft", "-o", results }).code, 2);
  const ProgramResult misspelt = run_program({ "accuracy", "cantilevr", "-o", results });
  EXPECT_EQ(misspelt.code, 1);
  expect_contains(misspelt.errors,
                  "nor a body of that name with a closed form: cantilever, stretched_block, active_bar");
  EXPECT_EQ(run({ "--tolerance", "1", "--time", "1" }).code, 2);
  EXPECT_EQ(run({ "--save", folder / "chosen.yaml" }).code, 2);
  const ProgramResult fine = run({ "--voxel", "1" });
  EXPECT_EQ(fine.code, 1);
  expect_contains(fine.errors, "is 2 mm; it must be smaller than the standard setting's, 1 mm");
  // before anything is baked, which this scene cannot be
  std::string unbakeable = bar;
  const std::string where = "centre: [0, 0, 16]";
  unbakeable.replace(unbakeable.find(where), where.size(), "centre: [0, 0, 99]");
  std::ofstream(scene) << unbakeable;
  const ProgramResult few = run_program({ "accuracy", scene, "--voxels", "5,2.5", "-o", results });
  EXPECT_EQ(few.code, 1);
  expect_contains(few.errors, "at least three are needed");
}

}  // namespace
}  // namespace frontalis
