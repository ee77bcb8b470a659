#pragma once

#include <string>
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
    strong,  ///< black line and points, the one that counts
    guide    ///< thin grey dashes, told by their label
  };
  struct Curve
  {
    std::string name;  ///< in the legend; empty: not in it
    std::vector<double> x, y;
    Style style = Style::line_and_points;
    std::vector<std::string> labels{};                ///< beside the points; empty: none
    std::string label_place = "left offset 0.7,0.7";  ///< of the labels beside their points, in gnuplot's words
    bool coloured_labels = false;                     ///< as the curve
  };

  std::string title;             ///< lines end with \n
  std::string x_label, y_label;  ///< with units
  bool x_log = false, y_log = false;
  /// Limits of an axis where the two differ.
  double x_from = 0, x_to = 0, y_from = 0, y_to = 0;
  std::vector<double> x_ticks, y_ticks{};  ///< where the axes have numbers; empty: gnuplot's choice
  std::vector<std::string> x_names;        ///< written at x = 0, 1, 2, ... instead of numbers
  double shaded_below = 0;                 ///< y under which the plot is grey; 0: nowhere
  std::string key = "top right";           ///< place of the legend in gnuplot's words; "below ...": under the axes
  std::vector<Curve> curves;
  int width = 800, height = 500;  ///< pixels
};

/// Writes PATH.png and PATH.svg; `path` has no extension. Throws Error where gnuplot fails, with what it said, and
/// where it is missing: then PATH.gnuplot is left, for a machine that has it.
void write_plot(const Plot& plot, const std::string& path);

}  // namespace frontalis
