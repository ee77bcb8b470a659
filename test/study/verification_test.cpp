#include "frontalis/study/verification.hpp"

#include "files.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

using namespace frontalis;

TEST(Check, PassesWithinItsBoundAlone)
{
  EXPECT_TRUE((Check{ "", "", 2, 2.1, 0.051 }).passed());
  EXPECT_FALSE((Check{ "", "", -2, -2.1, 0.049 }).passed());
  EXPECT_FALSE((Check{ "", "", 0, -0.2, 0.1, false }).passed());
  EXPECT_TRUE((Check{ "", "", 0, -0.2, std::nan(""), false }).passed()) << "no bound: shown as it is";
  EXPECT_EQ((Check{ "", "", 0, std::nan(""), std::nan(""), false }).verdict(), "FAIL") << "no figure";
  EXPECT_FALSE((Check{ "", "", 0, std::nan(""), 0.1, false }).passed());
  EXPECT_FALSE((Check{ "", "", 0, std::nan(""), std::nan(""), false }).passed());
}

TEST(Check, LineSaysNameFiguresAndVerdict)
{
  const std::string line = check_line("bar", { "length", "m", 2, 2.5, 0.1, false });
  for (const char* const part : { "bar", "length", " 2 ", " 2.5 ", " m ", " 0.5 ", " 0.1 ", "FAIL" })
    EXPECT_NE(line.find(part), std::string::npos) << part << " in " << line;
}

TEST(Cases, HaveNamesOfTheirOwnAndATextInTheManual)
{
  const std::string texts = text_of(std::string(FRONTALIS_SOURCE_DIRECTORY) + "/doc/verification/text.md");
  std::set<std::string> names;
  for (const auto& c : verification_cases())
  {
    EXPECT_TRUE(names.insert(c.name).second) << c.name;
    EXPECT_NE(texts.find("\n## " + c.name + ": "), std::string::npos) << c.name;
  }
}

// Runs a case on every backend of this machine.
class ContactCase : public testing::TestWithParam<const char*>
{
};

TEST_P(ContactCase, IsRight)
{
  const auto cases = verification_cases();
  const auto found = std::find_if(cases.begin(), cases.end(), [](const auto& c) { return c.name == GetParam(); });
  ASSERT_NE(found, cases.end());
  Finding finding;
  found->run("cpu", finding);
  EXPECT_FALSE(finding.checks.empty());
  for (const Check& check : finding.checks)
    EXPECT_TRUE(check.passed()) << check_line(found->name, check);
}

INSTANTIATE_TEST_SUITE_P(Bodies, ContactCase,
                         testing::Values("contact_pressure", "contact_impact", "contact_wrench", "contact_incline"),
                         [](const auto& one) { return std::string(one.param); });

TEST(Manual, HasTheTextOfEachCaseAroundItsFigures)
{
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "manual");
  std::ofstream(folder / "manual/text.md")
      << "# Bars\n\nAll hold.\n\n## bar: A bar\n\nis *pulled*\n\n### After\n\nand let go\n";
  Finding finding;
  finding.checks.absolute("length", "m", 2, 2.5, 1);
  write_manual({ { "bar", finding } }, folder / "manual.md");
  const std::string manual = text_of(folder / "manual.md");
  EXPECT_EQ(manual.find("# Bars\n\nAll hold.\n\n## All cases\n"), 0u) << manual;
  const std::size_t title = manual.find("## A bar\n"), before = manual.find("is *pulled*"),
                    check = manual.find("| length | m | 2 | 2.5 | 0.5 | 1 | pass |"), after = manual.find("and let go");
  EXPECT_TRUE(title < before && before < check && check < after && after < manual.size()) << manual;
  EXPECT_NE(manual.find("| [A bar](#bar) | 1 | 1 | 50 |"), std::string::npos) << manual;
  EXPECT_THROW(write_manual({ { "rod", finding } }, folder / "manual.md"), Error);
}
