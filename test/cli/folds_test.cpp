// Folds of the living forehead do not depend on the voxels. They are tested on a strip of it, 15 mm wide.

#include "cli/program.hpp"

#include <cmath>
#include <regex>
#include <sstream>

namespace frontalis
{
namespace
{

const std::string config = FRONTALIS_SOURCE_DIRECTORY "/config/";

std::string replaced(const std::string& text, const std::string& from, const std::string& to)
{
  const std::size_t at = text.find(from);
  if (at == std::string::npos)
    ADD_FAILURE() << "living_forehead.yaml lacks: " << from;
  return at == std::string::npos ? text : std::string(text).replace(at, from.size(), to);
}

// The left half of the scene between planes on which the tissue glides. The muscle is weaker, since no temple holds the
// skin; it raises the brow by 11 mm.
std::string strip()
{
  const std::string crop = ", crop: {lower: [null, 12, null], upper: [null, 27, null]}}";
  std::string text = replaced(text_of(config + "living_forehead.yaml"), "tissue: true}", "tissue: true" + crop);
  text = replaced(text, "skin: {surface: skin}", "skin: {surface: skin" + crop);
  text =
      replaced(text, "surfaces:\n", "surfaces:\n  sides: {shape: box, centre: [0, 19.5, 40], size: [400, 15, 400]}\n");
  text = replaced(text, "constraints:\n", "constraints:\n  - {name: sides, sliding: sides, within: 0.3}\n");
  text = replaced(text, ", frontalis_right: 0.75}", "}");
  text = std::regex_replace(text, std::regex("stress_reference: 160 kPa"), "stress_reference: 75 kPa");
  const std::regex elsewhere("_right|corrugator|procerus|temples|glabella:|hairline:|brow_left: \\[");
  std::string kept;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (!std::regex_search(line, elsewhere))
      kept += line + '\n';
  return kept;
}

// The folds [m] of raised brows.
nlohmann::json folds(const std::string& accuracy)
{
  const TemporaryFolder folder;
  folder.write("skin_middle.yaml", text_of(config + "skin_middle.yaml"));
  const std::string scene = folder.write("strip.yaml", strip());
  const ProgramResult run =
      run_program({ "run", scene, "--accuracy", accuracy, "--expression", "raise_brows", "--ramp", "0.4", "--seconds",
                    "0.7", "--frame-rate", "2", "--frames", folder / "frames", "--wrinkles-in=14,24,25,80" });
  EXPECT_EQ(run.code, 0) << run.errors;
  return run.code == 0 ? json_from(text_of(folder / "frames/run.json")).at("wrinkles") : nlohmann::json();
}

}  // namespace

TEST(Folds, of_the_living_forehead_are_the_same_with_smaller_voxels)
{
  const nlohmann::json coarse = folds("standard"), fine = folds("fine");
  ASSERT_FALSE(coarse.is_null() || fine.is_null());
  for (const auto& [key, bound] : { std::pair{ "depth_m", 0.2 }, { "deepest_m", 0.2 }, { "spacing_m", 0.1 } })
  {
    const double found = coarse.at(key), wanted = fine.at(key);
    EXPECT_NEAR(found, wanted, bound * wanted) << key;
  }
  EXPECT_EQ(std::lround(coarse.at("count").get<double>()), std::lround(fine.at("count").get<double>()));
  EXPECT_GE(coarse.at("count"), 2.5);
  EXPECT_GT(coarse.at("depth_m"), 0.5e-3);
  EXPECT_LT(fine.at("depth_m"), 2.5e-3);
  EXPECT_GT(coarse.at("spacing_m"), 8e-3);
  EXPECT_LT(coarse.at("spacing_m"), 16e-3);
}

}  // namespace frontalis
