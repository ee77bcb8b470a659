// `frontalis faces` and the motions of landmarks of the shipped heads in expressions.

#include "cli/program.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace frontalis
{
namespace
{

const std::string config = FRONTALIS_SOURCE_DIRECTORY "/config/";

/// Runs the command `faces` and returns its figures by expression and landmark.
std::map<std::string, std::map<std::string, nlohmann::json>> faces(std::vector<std::string> arguments)
{
  const TemporaryFolder folder;
  const std::string file = folder / "faces.json";
  arguments.insert(arguments.begin(), "faces");
  arguments.insert(arguments.end(), { "--measure", "--json", file });
  const ProgramResult result = run_program(arguments);
  EXPECT_EQ(result.code, 0) << result.errors;
  std::map<std::string, std::map<std::string, nlohmann::json>> found;
  if (result.code == 0)
    for (const nlohmann::json& row : json_from(text_of(file)))
      found[row.at("expression")].emplace(row.at("landmark"), row);
  return found;
}

double up(const nlohmann::json& row) { return row.at("up [mm]"); }
double outward(const nlohmann::json& row) { return row.at("outward [mm]"); }

/// Expects that left and right differ by at most 0.5 mm, as in people (Coulson 2002), plus a tenth of the motion.
void expect_symmetric(const std::map<std::string, nlohmann::json>& rows)
{
  for (const auto& [name, left] : rows)
  {
    const std::size_t end = name.rfind("_left");
    if (end == std::string::npos)
      continue;
    const nlohmann::json& right = rows.at(name.substr(0, end) + "_right");
    for (const char* axis : { "forward [mm]", "outward [mm]", "up [mm]" })
      EXPECT_NEAR(left.at(axis), right.at(axis), 0.5 + 0.1 * left.at("size [mm]").get<double>()) << name << ' ' << axis;
  }
}

TEST(Faces, the_generated_head_raises_its_brows_frowns_smiles_and_blinks)
{
  // The head is baked once for its expressions and for its hard cases.
  const TemporaryFolder folder;
  const std::string head = folder / "head.vtkhdf";
  ASSERT_EQ(run_program({ "bake", config + "head.yaml", "--accuracy", "draft", "--output", head }).code, 0);
  const ProgramResult hard = run_program({ "stability", "--scenes", folder / "", "--only", "head_switched",
                                           "head_at_full", "head_torn_lips", "head_blinks" });
  EXPECT_EQ(hard.code, 0) << hard.output;
  EXPECT_EQ(hard.output.find("skipped"), std::string::npos) << hard.output;
  auto found = faces({ head, "--only", "raise_brows,frown,smile,blink,raise_brows_left", "--seconds", "0.3" });
  ASSERT_EQ(found.size(), 5u);
  const auto half = found.extract("raise_brows_left");
  for (const auto& [expression, rows] : found)
  {
    EXPECT_GE(rows.size(), 20u) << expression;
    expect_symmetric(rows);
  }
  const auto& raised = found.at("raise_brows");
  for (const std::string side : { "_left", "_right" })
  {
    EXPECT_GT(up(raised.at("brow_mid" + side)), 2);
    for (const char* still : { "mouth_corner", "malar", "ala" })
      EXPECT_LT(raised.at(still + side).at("size [mm]"), 1) << still;
    const nlohmann::json& frowning = found.at("frown").at("brow_medial" + side);
    EXPECT_LT(outward(frowning), 0);
    EXPECT_LT(up(frowning), -0.5);
    const nlohmann::json& smiling = found.at("smile").at("mouth_corner" + side);
    EXPECT_GT(outward(smiling), 0.25);
    EXPECT_GT(up(smiling), 0.5);
    // the landmarks of the lids are 8.7 mm apart at rest; closed lids leave at most 1 mm open
    const auto& blinking = found.at("blink");
    EXPECT_LT(8.7 + up(blinking.at("lid_upper" + side)) - up(blinking.at("lid_lower" + side)), 1);
    EXPECT_LT(blinking.at("brow_mid" + side).at("size [mm]"), 1);
  }
  // the lines of the forehead are those of people: across it, 8 to 16 mm apart, 0.5 to 2.5 mm deep
  const ProgramResult run =
      run_program({ "run", head, "--expression", "raise_brows", "--ramp", "0.2", "--seconds", "0.4", "--frame-rate",
                    "10", "--frames", folder / "frames", "--wrinkles-in=-40,0,40,60" });
  ASSERT_EQ(run.code, 0) << run.errors;
  const nlohmann::json lines = json_from(text_of(folder / "frames/run.json")).at("wrinkles");
  EXPECT_GT(std::abs(lines.at("direction").at(1).get<double>()), 0.95) << lines;
  for (const auto& [key, least, most] : { std::tuple{ "spacing_m", 8e-3, 16e-3 }, { "depth_m", 0.5e-3, 2.5e-3 } })
  {
    EXPECT_GE(lines.at(key), least) << lines;
    EXPECT_LE(lines.at(key), most) << lines;
  }
  const auto long_ones = std::count_if(lines.at("furrows").begin(), lines.at("furrows").end(),
                                       [](const nlohmann::json& line) { return line.at("length_m") > 30e-3; });
  EXPECT_GE(long_ones, 3) << lines;
  // those of a frown run up between the brows, 6 to 12 mm apart
  const ProgramResult frowning =
      run_program({ "run", head, "--expression", "frown", "--ramp", "0.2", "--seconds", "0.4", "--frame-rate", "10",
                    "--frames", folder / "frames", "--wrinkles-in=-24,7,24,22" });
  ASSERT_EQ(frowning.code, 0) << frowning.errors;
  const nlohmann::json upright = json_from(text_of(folder / "frames/run.json")).at("wrinkles");
  EXPECT_GT(std::abs(upright.at("direction").at(2).get<double>()), 0.9) << upright;
  EXPECT_GE(upright.at("spacing_m"), 6e-3) << upright;
  EXPECT_LE(upright.at("spacing_m"), 12e-3) << upright;
  EXPECT_GE(upright.at("furrows").size(), 2u) << upright;
  // the left half of the expression moves the left side like the whole expression
  EXPECT_NEAR(up(half.mapped().at("brow_mid_left")), up(raised.at("brow_mid_left")), 1);
  EXPECT_LT(std::abs(up(half.mapped().at("brow_mid_right"))), 1);
}

TEST(Faces, nothing_compared_does_not_pass)
{
  const TemporaryFolder folder;
  const std::string people = folder.write("people.yaml", "smile: {still: [no_such_landmark]}\n");
  const ProgramResult result = run_program({ "faces", FRONTALIS_SOURCE_DIRECTORY "/test/ros/small.yaml", "--people",
                                             people, "--only", "shorten", "--seconds", "0.02" });
  EXPECT_EQ(result.code, 1);
  expect_contains(result.errors, "nothing was compared");
}

TEST(Faces, wrong_input_is_told)
{
  const TemporaryFolder folder;
  const std::string scene = config + "forehead.yaml";
  const ProgramResult unknown = run_program({ "faces", scene, "--only", "grin" });
  EXPECT_EQ(unknown.code, 1);
  expect_contains(unknown.errors, "no expression is called 'grin'; there is relax, ");
  const std::string people = folder.write("people.yaml", "smile:\n  landmarks:\n    - {landmark: lip, size: 3}\n");
  const ProgramResult wrong = run_program({ "faces", scene, "--people", people });
  EXPECT_EQ(wrong.code, 1);
  expect_contains(wrong.errors, "people.yaml:3: size: unknown key; allowed are landmark, along");
}

// Every expression of both heads is played without a fault. Only ./dev test --long runs this test.
TEST(DISABLED_EveryFace, of_the_generated_head_is_sound)
{
  const auto found = faces({ config + "head.yaml" });
  EXPECT_GE(found.size(), 15u);
  for (const auto& [expression, rows] : found)
    expect_symmetric(rows);
}

TEST(DISABLED_EveryFace, of_the_real_head_is_sound)
{
  const char* meshes = std::getenv("FRONTALIS_REAL_HEAD");
  if (meshes == nullptr)
    GTEST_SKIP() << "FRONTALIS_REAL_HEAD names no folder with the meshes of config/real_face.yaml";
  EXPECT_GE(faces({ config + "real_face.yaml", "--mesh-dir", meshes }).size(), 10u);
}

}  // namespace
}  // namespace frontalis
