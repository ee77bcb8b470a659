#include "frontalis/study/plot.hpp"

#include "frontalis/error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

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
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "frontalis_plot_test";
  std::filesystem::create_directories(folder);
  write_plot(parabola(), (folder / "parabola").string());
  std::ifstream svg(folder / "parabola.svg");
  const std::string text{ std::istreambuf_iterator<char>(svg), std::istreambuf_iterator<char>() };
  EXPECT_NE(text.find("x [m]"), std::string::npos);
  EXPECT_NE(text.find("x_2"), std::string::npos);
  EXPECT_GT(std::filesystem::file_size(folder / "parabola.png"), 3000u);
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder))
    ++files;
  EXPECT_EQ(files, 2u);
  std::filesystem::remove_all(folder);
}

TEST(Plot, BarsHaveNames)
{
  if (std::system("command -v gnuplot >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "gnuplot is not installed";
  const std::string path = (std::filesystem::path(testing::TempDir()) / "frontalis_bars").string();
  Plot plot;
  plot.key = "off";
  plot.x_names = { "gravity (1 %)", "it's viscous" };
  plot.curves = { { "", { 0, 1 }, { 3, 5 }, Plot::Style::bars } };
  write_plot(plot, path);
  std::ifstream svg(path + ".svg");
  const std::string text{ std::istreambuf_iterator<char>(svg), std::istreambuf_iterator<char>() };
  EXPECT_NE(text.find("gravity (1 %)"), std::string::npos);
  EXPECT_NE(text.find("viscous"), std::string::npos);
  for (const char* const extension : { ".png", ".svg" })
    std::filesystem::remove(path + extension);
}

TEST(Plot, SaysWhereItCannotWrite) { EXPECT_THROW(write_plot(parabola(), "/no such folder/plot"), Error); }
