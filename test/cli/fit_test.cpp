// `frontalis fit` and `frontalis retarget` find the controls of a motion from its landmarks.

#include "cli/program.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace frontalis
{
namespace
{

constexpr double determined_error = 0.05;  // largest error of an activation that the targets determine

// A slab on a plate with four strips of muscle below its upper side. Two strips are the same muscle under two names.
const std::string slab = R"(
unit: mm
surfaces:
  slab: {shape: box, size: [40, 20, 10]}
  plate: {shape: box, centre: [0, 0, -6], size: [50, 30, 2]}
  anchor: {shape: box, centre: [16, 0, 3], size: [3, 30, 3]}
  front_left: {shape: box, centre: [9, 5, 2.5], size: [18, 10, 5]}
  front_right: {shape: box, centre: [9, -5, 2.5], size: [18, 10, 5]}
  back: {shape: box, centre: [-9, 0, 2.5], size: [18, 20, 5]}
volumes:
  slab: {inside: slab, material: flesh, tissue: true}
  front_left: {inside: front_left, material: flesh}
  front_right: {inside: front_right, material: flesh}
  back: {inside: back, material: flesh}
  twin: {inside: back, material: flesh}
materials:
  flesh: {young: 20 kPa, poisson: 0.45, density: 1000}
muscles:
  front_left: {fibre: [1, 0, 0], stress_reference: 40 kPa}
  front_right: {fibre: [1, 0, 0], stress_reference: 40 kPa}
  back: {fibre: [1, 0, 0], stress_reference: 20 kPa}
  twin: {fibre: [1, 0, 0], stress_reference: 20 kPa}
constraints:
  - {name: ground, rigid: plate, within: 0.5}
skin: {surface: slab}
landmarks:
  front_left: [18, 5, 5]
  front_right: [18, -5, 5]
  middle: [0, 0, 5]
  back: [-18, 0, 5]
time: {damping: 300, frame_rate: 50}
accuracy:
  draft: {voxel: 5}
)";

// a slab like `slab`, but without muscles; a bone pulls its front
std::string driven_slab()
{
  std::string scene = slab;
  scene.replace(scene.find("  front_left: {inside"), scene.find("materials:") - scene.find("  front_left: {inside"),
                "");
  scene.replace(scene.find("muscles:"), scene.find("constraints:") - scene.find("muscles:"), "");
  return scene.replace(scene.find("skin:"), 0, "  - {name: anchor, rigid: anchor, bone: anchor, within: 2.5}\n");
}

class Fit : public testing::Test
{
protected:
  void make_model(const std::string& scene)
  {
    const auto result = run_program({ "bake", folder.write("slab.yaml", scene), "-o", model });
    ASSERT_EQ(result.code, 0) << result.errors;
  }

  nlohmann::json run(std::vector<std::string> options)
  {
    options.insert(options.begin(), { "run", model, "--threads", "1", "--frames", folder / "known" });
    const auto result = run_program(options);
    EXPECT_EQ(result.code, 0) << result.errors;
    return json_from(text_of(folder / "known" + "/run.json"));
  }

  // the motion of landmarks of a run, as targets of a fit
  std::string targets_of(const nlohmann::json& run, const std::string& more = {})
  {
    std::string text = "deviation: 0.02\n" + more + "moved:\n";
    for (const auto& [name, moved] : run["landmarks"].items())
      text += "  " + name + ": [" + moved["forward_mm"].dump() + ", " + moved["left_mm"].dump() + ", " +
              moved["up_mm"].dump() + "]\n";
    return folder.write("targets.yaml", text);
  }

  nlohmann::json fit(std::vector<std::string> options)
  {
    options.insert(options.begin(), { "fit", model, "--threads", "1", "--cache", folder / "cache", "--json", answer });
    const auto result = run_program(options);
    EXPECT_EQ(result.code, 0) << result.errors;
    output = result.output;
    return json_from(text_of(answer));
  }

  TemporaryFolder folder;
  std::string model = folder / "slab.vtkhdf", answer = folder / "answer.json", output;
};

TEST_F(Fit, recovers_the_activations_that_landmarks_determine)
{
  make_model(slab);
  const std::map<std::string, double> known{ { "front_left", 0.7 }, { "front_right", 0.25 } };
  const auto moved = run({ "--activate", "front_left=0.7,front_right=0.25,back=0.4,twin=0.4", "--to-equilibrium" });
  const std::string targets = targets_of(moved);
  const auto found = fit({ "--target", targets, "--activations", folder / "found.csv" });
  EXPECT_GT(found["influence_s"].get<double>(), 0);
  double shared = 0;
  for (const auto& unknown : found["unknowns"])
  {
    const std::string name = unknown["name"];
    if (const auto wanted = known.find(name); wanted != known.end())
    {
      EXPECT_TRUE(unknown["determined"]) << unknown;
      EXPECT_NEAR(unknown["value"], wanted->second, determined_error) << unknown;
      continue;
    }
    // nothing distinguishes the two equal muscles, but the sum of their activations is determined
    EXPECT_FALSE(unknown["determined"]) << unknown;
    EXPECT_EQ(unknown["like"], name == "twin" ? "back" : "twin");
    EXPECT_LT(unknown["correlation"].get<double>(), -0.9);
    shared += unknown["value"].get<double>();
  }
  EXPECT_NEAR(shared, 0.8, 2 * determined_error);
  ASSERT_LE(found["errors_m"].size(), 5U);
  for (const auto& landmark : found["landmarks"])
    EXPECT_LE(landmark["error_m"].get<double>(), 0.1e-3) << landmark;
  EXPECT_EQ(found["covariance"].size(), 4U);

  // a run with the answer brings landmarks to their targets
  const auto again = run({ "--activations", folder / "found.csv", "--to-equilibrium" });
  for (const auto& [name, place] : moved["landmarks"].items())
    EXPECT_NEAR(again["landmarks"][name]["forward_mm"], place["forward_mm"], 0.1) << name;

  // the influence was stored, so a second fit does not measure it; with --runs 0 it makes no simulations either
  const auto kept = fit({ "--target", targets, "--runs", "0" });
  EXPECT_EQ(kept["influence_s"], 0);
  EXPECT_TRUE(kept["errors_m"].empty());
  EXPECT_TRUE(kept["landmarks"][0]["reached_m"][0].is_null());
}

TEST_F(Fit, stays_within_limits_and_leaves_free_what_is_not_given)
{
  make_model(slab);
  const std::string targets =
      folder.write("targets.yaml",
                   "unknowns: {front_left: [0, 0.3]}\nmoved: {front_left: [-20, null, null]}\nat: {back: [null, "
                   "null, 5]}\n");
  const auto found = fit({ "--target", targets, "--runs", "1" });
  ASSERT_EQ(found["unknowns"].size(), 1U);
  EXPECT_EQ(found["unknowns"][0]["value"], 0.3);
  EXPECT_LT(found["landmarks"][1]["error_m"].get<double>(), 1e-3) << found["landmarks"];
}

TEST_F(Fit, finds_how_a_bone_moved)
{
  make_model(driven_slab());
  const auto moved = run({ "--bone", "anchor=1.5,0,-0.8,0,0,0", "--to-equilibrium" });
  const auto found =
      fit({ "--target", targets_of(moved, "unknowns: {anchor.x: [-3, 3], anchor.y: [-3, 3], anchor.z: [-3, 3]}\n") });
  const std::vector<double> known{ 1.5, 0, -0.8 };
  for (std::size_t axis = 0; axis < known.size(); ++axis)
  {
    EXPECT_TRUE(found["unknowns"][axis]["determined"]);
    EXPECT_NEAR(found["unknowns"][axis]["value"], known[axis], 0.05 * 3) << found["unknowns"][axis];
  }
}

TEST_F(Fit, follows_a_track)
{
  make_model(slab);
  const std::string table = folder.write(
      "known.csv", "time,front_left,front_right,back\n0,0,0,0\n0.2,0.6,0.1,0.5\n0.3,0.6,0.1,0.5\n0.5,0.1,0.5,0.2\n");
  run({ "--activations", table, "--seconds", "0.6" });
  const std::string unknowns =
      folder.write("unknowns.yaml", "deviation: 0.02\nunknowns: [front_left, front_right, back]\n");
  std::vector<std::string> arguments{ "retarget",           model,       folder / "known" + "/landmarks.csv",
                                      "--unknowns",         unknowns,    "-o",
                                      folder / "found.csv", "--threads", "1" };
  const bool draws = std::system("command -v gnuplot >/dev/null 2>&1") == 0;
  if (draws)
    arguments.insert(arguments.end(), { "--plot", folder / "errors.png" });
  const auto result = run_program(arguments);
  ASSERT_EQ(result.code, 0) << result.errors;
  EXPECT_EQ(std::ifstream(folder / "errors.png").good(), draws);
  expect_contains(result.output, "error after each simulation");
  const std::string found = text_of(folder / "found.csv");
  expect_contains(found, "time,front_left,front_right,back\n");
  const auto wanted = json_from(text_of(folder / "known" + "/run.json"))["landmarks"];
  const auto again = run({ "--activations", folder / "found.csv", "--seconds", "0.6" });
  for (const auto& [name, place] : wanted.items())
    for (const char* axis : { "forward_mm", "left_mm", "up_mm" })
      EXPECT_NEAR(again["landmarks"][name][axis], place[axis], 0.1) << name << " " << axis;
}

TEST_F(Fit, says_what_is_wrong_with_a_request)
{
  make_model(slab);
  for (const auto& [text, fault] : {
           std::pair{ "moved: {nose: [1, 2, 3]}", "no landmark is called 'nose'; the landmarks are front_left" },
           { "moved: {middle: [1, 2]}", "targets.yaml:1: must be three coordinates" },
           { "deviation: 0\nmoved: {middle: [1, 2, 3]}", "targets.yaml:1: deviation: must be above 0" },
           { "unknowns: [tongue]\nmoved: {middle: [1, 2, 3]}", "tongue" },
           { "unknowns: {back: [1, 0]}\nmoved: {middle: [1, 2, 3]}", "limits of 'back'" },
           { "unknowns: {back: [0, 2]}\nmoved: {middle: [1, 2, 3]}", "back" },
           { "wanted: {}", "wanted: unknown key" },
           { "deviation: 1", "has no targets" },
       })
  {
    const auto result = run_program({ "fit", model, "--target", folder.write("targets.yaml", text) });
    EXPECT_EQ(result.code, 1) << text;
    expect_contains(result.errors, fault);
  }
  for (const auto& [text, fault] : {
           std::pair{ "time_s,landmark\n", "has no column forward_mm" },
           { "time_s,landmark,forward_mm,left_mm,up_mm\n0,middle,0,0,x\n", "track.csv:2: found 'x'" },
           { "time_s,landmark,forward_mm,left_mm,up_mm\n0,middle,0,0,0\n0,middle,0,0,0\n",
             "track.csv:3: landmark 'middle' is there twice" },
           { "time_s,landmark,forward_mm,left_mm,up_mm\n0,nose,0,0,0\n", "has a landmark 'nose'" },
       })
  {
    const auto result = run_program({ "retarget", model, folder.write("track.csv", text), "-o", folder / "found.csv" });
    EXPECT_EQ(result.code, 1) << text;
    expect_contains(result.errors, fault);
  }
}

}  // namespace
}  // namespace frontalis
