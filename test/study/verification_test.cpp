#include "frontalis/study/verification.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

using namespace frontalis;

TEST(Check, PassesWithinItsBoundAlone)
{
  EXPECT_TRUE(relative_check("", "", 2, 2.1, 0.051).passed());
  EXPECT_FALSE(relative_check("", "", -2, -2.1, 0.049).passed());
  EXPECT_FALSE(absolute_check("", "", 0, -0.2, 0.1).passed());
  EXPECT_TRUE(absolute_check("", "", 0, -0.2, std::nan("")).passed()) << "no bound: shown as it is";
  EXPECT_FALSE(absolute_check("", "", 0, std::nan(""), 0.1).passed());
  EXPECT_FALSE(absolute_check("", "", 0, std::nan(""), std::nan("")).passed());
}

TEST(Check, LineSaysNameFiguresAndVerdict)
{
  const std::string line = check_line("bar", absolute_check("length", "m", 2, 2.5, 0.1));
  for (const char* const part : { "bar", "length", " 2 ", " 2.5 ", " m ", " 0.5 ", " 0.1 ", "FAIL" })
    EXPECT_NE(line.find(part), std::string::npos) << part << " in " << line;
}

TEST(Cases, HaveNamesOfTheirOwn)
{
  std::set<std::string> names;
  for (const auto& c : verification_cases())
    EXPECT_TRUE(names.insert(c.name).second) << c.name;
}
