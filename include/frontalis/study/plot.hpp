#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace frontalis
{

/// Curves over one pair of axes, drawn by gnuplot.
struct Plot
{
  enum class Style
  {
    points,
    line,
    dashed,  ///< for theory, bounds and slopes
    line_and_points,
    bars,
    faint,   ///< small grey points
    strong,  ///< black line and points, for the main curve
    guide    ///< thin grey dashes, named by a label instead of the legend
  };
  struct Curve
  {
    std::string name;  ///< name in the legend; empty: not in the legend
    std::vector<double> x{}, y{};
    Style style = Style::line_and_points;
    std::vector<std::string> labels{};                ///< labels beside the points; empty: none
    std::string label_place = "left offset 0.7,0.7";  ///< offset of labels from their points, in gnuplot's syntax
    bool coloured_labels = false;                     ///< labels have the colour of the curve

    void add(double at_x, double at_y)
    {
      x.push_back(at_x);
      y.push_back(at_y);
    }
  };

  std::string title;             ///< \n separates lines
  std::string x_label, y_label;  ///< labels of the axes, with units
  bool x_log = false, y_log = false;
  /// Lower and upper limit of each axis; if they are equal, gnuplot chooses the limits.
  std::array<double, 2> x_range{}, y_range{};
  std::vector<double> x_ticks{}, y_ticks{};  ///< numbers on the axes; empty: gnuplot chooses them
  std::vector<std::string> x_names{};        ///< labels at x = 0, 1, 2, ... instead of numbers
  double shaded_below = 0;                   ///< the plot is grey below this y; 0: no grey
  std::string key = "top right";  ///< position of the legend in gnuplot's syntax; "below ...": under the axes
  std::vector<Curve> curves{};
  int width = 800, height = 500;  ///< pixels
};

/// Writes PATH.png and PATH.svg; `path` has no extension. Throws Error if gnuplot fails or is missing, and leaves
/// PATH.gnuplot, which gnuplot can draw on another machine.
void write_plot(const Plot& plot, const std::string& path);

/// The text as a string in gnuplot's commands.
std::string gnuplot_string(const std::string& text);
/// Runs commands of gnuplot. Throws Error if it fails or is missing, and leaves the commands in PATH.gnuplot.
void run_gnuplot(const std::string& commands, const std::string& path);

/// File names without extension, with their plots.
using Plots = std::vector<std::pair<std::string, Plot>>;
/// Writes plots to a folder. Returns markdown that shows them, for a file next to the folder.
std::string write_plots(const Plots& plots, const std::string& folder);

}  // namespace frontalis
