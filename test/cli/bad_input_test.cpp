// meshes and scenes that no model can be made of: one clear message, exit code 1, no file left

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

}  // namespace
}  // namespace frontalis
