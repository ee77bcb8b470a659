// meshes and scenes of which no model can be made give one clear message and exit code 1, and leave no file

#include "cli/program.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace frontalis
{
namespace
{

const std::string folder_of_bad = std::string(FRONTALIS_SOURCE_DIRECTORY) + "/test/model/bad";

class BadInput : public testing::TestWithParam<std::string>
{
};

std::vector<std::string> bad_inputs()
{
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder_of_bad))
    if (entry.path().extension() == ".yaml")
      names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

TEST_P(BadInput, ends_with_1_and_one_message_that_names_file_place_and_remedy)
{
  const std::string path = folder_of_bad + "/" + GetParam() + ".yaml";
  const std::string text = text_of(path);
  const std::string mark = "# says: ";
  ASSERT_EQ(text.compare(0, mark.size(), mark), 0) << "the first line says what is expected";
  const TemporaryFolder folder;
  const ProgramResult result = run_program({ "bake", path, "-o", folder / "model.vtkhdf" });
  EXPECT_EQ(result.code, 1);
  EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
  EXPECT_EQ(result.errors.compare(0, path.size(), path), 0) << result.errors;
  expect_contains(result.errors, text.substr(mark.size(), text.find('\n') - mark.size()));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

INSTANTIATE_TEST_SUITE_P(inputs, BadInput, testing::ValuesIn(bad_inputs()),
                         [](const auto& input) { return input.param; });

TEST(BadInputs, are_many) { EXPECT_GE(bad_inputs().size(), 15u); }

TEST(Bake, interrupted_leaves_no_file_and_130)
{
  // use so many voxels that the bake is still making them when the line that names this stage triggers the interrupt
  const TemporaryFolder folder;
  const std::string scene = std::string(FRONTALIS_SOURCE_DIRECTORY) + "/config/forehead.yaml";
  const std::string model = folder / "model.vtkhdf";
  const std::string log = folder / "log";
  const std::string script = folder / "script";
  // use job control (set -m), because a shell's background processes otherwise ignore interrupts
  std::ofstream(script) << "set -m\nstdbuf -o0 '" << FRONTALIS_PROGRAM << "' bake '" << scene << "' --voxel 0.4 -o '"
                        << model << "' > '" << log << "' 2>&1 &\npid=$!\nuntil grep -q voxels '" << log
                        << "' || ! kill -0 $pid; do sleep 0.02; done\nkill -INT $pid\nwait $pid\necho $? > '" << log
                        << ".code'\n";
  ASSERT_EQ(std::system(("bash '" + script + "'").c_str()), 0);
  EXPECT_EQ(text_of(log + ".code"), "130\n");
  expect_contains(text_of(log), "interrupted\n");
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    EXPECT_EQ(entry.path().string().find("vtkhdf"), std::string::npos) << entry.path();
}

}  // namespace
}  // namespace frontalis
