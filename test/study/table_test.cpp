#include "frontalis/study/table.hpp"

#include "files.hpp"
#include "frontalis/error.hpp"
#include "frontalis/study/faces.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <iterator>

using namespace frontalis;

namespace
{

Table small_table()
{
  Table table({ "name", "λ [m]" });
  table.add({ "a, \"b\"", 0.1 });
  table.add({ "c", std::nan("") });
  return table;
}

}  // namespace

TEST(Table, TextIsAligned) { EXPECT_EQ(small_table().text(), "name    λ [m]\na, \"b\"  0.1\nc\n"); }

TEST(Table, MarkdownCsvAndJson)
{
  EXPECT_EQ(small_table().markdown(), "| name | λ [m] |\n|---|---|\n| a, \"b\" | 0.1 |\n| c |  |\n");
  EXPECT_EQ(small_table().csv(), "name,λ [m]\r\n\"a, \"\"b\"\"\",0.1\r\nc,\r\n");
  EXPECT_EQ(small_table().json(),
            "[\n {\n  \"name\": \"a, \\\"b\\\"\",\n  \"λ [m]\": 0.1\n },\n"
            " {\n  \"name\": \"c\",\n  \"λ [m]\": null\n }\n]\n");
}

TEST(Table, RefusesARowOfAnotherLength)
{
  Table table({ "name" });
  EXPECT_THROW(table.add({ "a", 1.0 }), Error);
}

TEST(Json, WholeNumbersHaveNoFraction)
{
  Table table({ "voxels", "share" });
  table.add({ 5.0, 0.5 });
  EXPECT_EQ(table.json(), "[\n {\n  \"voxels\": 5,\n  \"share\": 0.5\n }\n]\n");
}

TEST(Json, TextThatIsNoUtf8IsReplaced)
{
  Table table({ "name" });
  table.add({ "\xff" });
  EXPECT_EQ(table.json(), "[\n {\n  \"name\": \"\uFFFD\"\n }\n]\n");
}

TEST(Readable, HasAsManyDigitsAsAsked)
{
  EXPECT_EQ(readable(1.0 / 3, 3), "0.333");
  EXPECT_EQ(readable(1e-7), "1e-07");
  EXPECT_EQ(readable(2), "2");
  EXPECT_EQ(readable(std::nan("")), "");
}

TEST(Wrapped, BreaksTextAndKeepsTablesWhole)
{
  EXPECT_EQ(wrapped("one two three\n\n- four five six\n\n| a b | c d |\n", 9),
            "one two\nthree\n\n- four\n  five\n  six\n\n| a b | c d |\n");
  EXPECT_EQ(wrapped("a longer_than_a_line b\n", 6), "a\nlonger_than_a_line\nb\n");
}

TEST(WriteText, WritesAWholeFileAndNothingElse)
{
  const TemporaryFolder folder;
  write_text(folder / "x", "old and long");
  write_text(folder / "x", "new");
  EXPECT_EQ(text_of(folder / "x"), "new");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(WriteText, NamesTheFile)
{
  try
  {
    write_text("/no such folder/x", "");
    FAIL();
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("/no such folder/x"), std::string::npos);
  }
}

TEST(FaceRow, FailsIfItsSizeIsNoNumber)
{
  FaceRow row;
  row.most = 1e-3;
  EXPECT_TRUE(row.passed());
  row.size = NAN;
  EXPECT_FALSE(row.passed());
}
