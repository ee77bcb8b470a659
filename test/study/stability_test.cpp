// The files of hard cases. The bounds of a case come from its file, and faults of files are reported.

#include "frontalis/study/stability.hpp"

#include "frontalis/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

using namespace frontalis;

namespace
{

namespace fs = std::filesystem;

const fs::path sources = fs::path(FRONTALIS_SOURCE_DIRECTORY) / "test/stability";

// Copies of the files of all cases, with one line changed in one of them.
class StabilityFile : public ::testing::Test
{
protected:
  std::string folder(const std::string& old, const std::string& now)
  {
    const fs::path copy = fs::path(::testing::TempDir()) /
                          ("stability_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(copy);
    fs::copy(sources, copy);
    std::ifstream in(copy / "sharp_ridge.yaml");
    std::string text{ std::istreambuf_iterator<char>(in), {} };
    const std::size_t at = text.find(old);
    EXPECT_NE(at, std::string::npos);
    text.replace(at, old.size(), now);
    std::ofstream(copy / "sharp_ridge.yaml") << text;
    return copy.string();
  }
  Trial played(const std::string& in)
  {
    for (const StabilityCase& c : stability_cases(in))
      if (c.name == "sharp_ridge")
        return run_case(c, {});
    return {};
  }
  std::string refusal(const std::string& in)
  {
    try
    {
      stability_cases(in);
    }
    catch (const Error& error)
    {
      return error.what();
    }
    return {};
  }
};

}  // namespace

TEST_F(StabilityFile, EveryOneHasACase)
{
  std::vector<std::string> files, cases;
  for (const auto& entry : fs::directory_iterator(sources))
    if (entry.is_regular_file())
      files.push_back(entry.path().stem().string());
  for (const StabilityCase& c : stability_cases(sources.string()))
    cases.push_back(c.name);
  std::sort(files.begin(), files.end());
  std::sort(cases.begin(), cases.end());
  EXPECT_EQ(files, cases);
}

TEST_F(StabilityFile, ItsBoundsDecide)
{
  EXPECT_TRUE(played(folder("tests: [cpu, reference]", "tests: [cpu]")).passed());
  const Trial strict = played(folder("kept_level: 5 um", "kept_level: 0.1 um"));
  EXPECT_TRUE(strict.failure.empty()) << strict.failure;
  EXPECT_FALSE(strict.passed());
}

TEST_F(StabilityFile, TellsWhatIsMissingOrTooMuch)
{
  EXPECT_NE(played(folder("pull: 60 m/s2\n", "")).failure.find("sharp_ridge.yaml: pull: is missing"),
            std::string::npos);
  EXPECT_NE(played(folder("level: 5 um", "level: 20 mm")).failure.find("'20 mm'; must be a number in um"),
            std::string::npos);
  EXPECT_NE(played(folder("[8, 3, 2]", "[8, 3.5, 2]")).failure.find("size: must be three whole numbers"),
            std::string::npos);
  EXPECT_NE(played(folder("[8, 3, 2]", "[8, 3]")).failure.find("size: has 2 values; must have 3"), std::string::npos);
  EXPECT_NE(played(folder("160 ms", "160 m")).failure.find("drag: must be one number in s or ms"), std::string::npos);
  EXPECT_NE(played(folder("ridge: 9 mm", "ridge: 9 mm\nedge: 3 mm")).failure.find("edge"), std::string::npos);
}

TEST_F(StabilityFile, IsRefusedWhereItSaysNothing)
{
  EXPECT_NE(refusal(folder("hard: ", "easy: ")).find("sharp_ridge.yaml: hard: is missing"), std::string::npos);
  EXPECT_NE(refusal(folder("{bounds.energy}", "{bounds.engery}")).find("{bounds.engery}"), std::string::npos);
  EXPECT_NE(refusal(folder("[cpu, reference]", "[cpu, gpu]")).find("tests: 'gpu'; allowed are"), std::string::npos);
  EXPECT_NE(refusal(folder("size: [8, 3, 2]", "size: [8, 3, 2")).find("sharp_ridge.yaml:"), std::string::npos);
}
