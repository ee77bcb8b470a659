#include "frontalis/study/plot.hpp"

#include "files.hpp"
#include "frontalis/error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

using namespace frontalis;

namespace
{

Plot parabola()
{
  Plot plot;
  plot.title = "it's a parabola";
  plot.x_label = "x [m]";
  plot.y_label = "y [m2]";
  plot.x_log = plot.y_log = true;
  plot.curves = { { "x_2", { 1, 2, 3 }, { 1, 4, 9 }, Plot::Style::line_and_points },
                  { "", { 1, 2, 3 }, { 1, std::nan(""), 3 }, Plot::Style::dashed } };
  return plot;
}

}  // namespace

TEST(Plot, WritesAPictureInBothFormatsAndLeavesNothingElse)
{
  if (std::system("command -v gnuplot >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "gnuplot is not installed";
  const TemporaryFolder folder;
  // A path may contain special characters of the shell.
  write_plot(parabola(), folder / "it's; a $parabola");
  const std::string text = text_of(folder / "it's; a $parabola.svg");
  EXPECT_NE(text.find("x [m]"), std::string::npos);
  EXPECT_NE(text.find("x_2"), std::string::npos);
  EXPECT_GT(std::filesystem::file_size(folder / "it's; a $parabola.png"), 3000u);
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path()))
    ++files;
  EXPECT_EQ(files, 2u);
}

TEST(Plot, BarsHaveNames)
{
  if (std::system("command -v gnuplot >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "gnuplot is not installed";
  const TemporaryFolder folder;
  const std::string path = folder / "bars";
  Plot plot;
  plot.key = "off";
  plot.x_names = { "gravity (1 %)", "it's viscous" };
  plot.curves = { { "", { 0, 1 }, { 3, 5 }, Plot::Style::bars } };
  write_plot(plot, path);
  const std::string text = text_of(path + ".svg");
  EXPECT_NE(text.find("gravity (1 %)"), std::string::npos);
  EXPECT_NE(text.find("viscous"), std::string::npos);
}

TEST(Plot, SaysWhereItCannotWrite) { EXPECT_THROW(write_plot(parabola(), "/no such folder/plot"), Error); }
