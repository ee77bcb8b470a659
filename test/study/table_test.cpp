#include "frontalis/study/table.hpp"

#include "frontalis/error.hpp"

#include <gtest/gtest.h>

#include <cmath>

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
            "[\n {\"name\": \"a, \\\"b\\\"\", \"λ [m]\": 0.1},\n"
            " {\"name\": \"c\", \"λ [m]\": null}\n]\n");
}

TEST(Table, RefusesARowOfAnotherLength)
{
  Table table({ "name" });
  EXPECT_THROW(table.add({ "a", 1.0 }), Error);
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
