#include "frontalis/study/plot.hpp"

#include "frontalis/error.hpp"
#include "frontalis/study/table.hpp"

#include <fmt/core.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <sstream>

namespace frontalis
{
namespace
{

// Colours that colour-blind readers can tell apart (Okabe & Ito 2008).
const char* const colours[] = { "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000" };
const char* const marks[] = { "7", "5" };
const char* const more_marks[] = { "9", "13", "11" };

std::string replaced(const std::string& text, const char* what, const char* by)
{
  return std::regex_replace(text, std::regex(what), by);
}

const char* colour_of(std::size_t index) { return colours[index % std::size(colours)]; }

std::string style_of(const Plot::Curve& curve, std::size_t index)
{
  const std::string colour = std::string(" lc rgb '") + colour_of(index) + "'";
  // A colour that is used again gets other marks.
  const bool again = index >= std::size(colours);
  const std::string point = std::string(" pt ") + (again ? more_marks[index % 3] : marks[index % 2]) + " ps 0.9";
  const std::map<Plot::Style, std::string> styles = {
    { Plot::Style::points, "with points" + point + colour },
    { Plot::Style::line, "with lines lw 2" + colour },
    { Plot::Style::dashed, "with lines lw 1.5 dt 2" + colour },
    { Plot::Style::line_and_points, "with linespoints lw 2" + point + colour },
    { Plot::Style::bars, "with boxes fs solid 0.8 noborder" + colour },
    { Plot::Style::faint, "with points pt 7 ps 0.5 lc rgb '#bbbbbb'" },
    { Plot::Style::strong, "with linespoints lw 2.5 pt 7 ps 1.2 lc rgb '#222222'" },
    { Plot::Style::guide, "with lines lw 1.2 dt 4 lc rgb '#666666'" }
  };
  return styles.at(curve.style);
}

std::string script(const Plot& plot, const std::string& path)
{
  std::ostringstream out;
  out.precision(9);
  for (std::size_t c = 0; c < plot.curves.size(); ++c)
  {
    const Plot::Curve& curve = plot.curves[c];
    out << "$curve" << c << " << EOD\n";
    for (std::size_t i = 0; i < curve.x.size(); ++i)
      if (std::isfinite(curve.x[i]) && std::isfinite(curve.y[i]))
        out << curve.x[i] << ' ' << curve.y[i] << '\n';
    out << "EOD\n";
    for (std::size_t i = 0; i < curve.labels.size(); ++i)
      if (!curve.labels[i].empty())
        out << "set label " << gnuplot_string(curve.labels[i]) << " at " << curve.x[i] << ',' << curve.y[i] << ' '
            << curve.label_place << " font ',13' tc rgb '" << (curve.coloured_labels ? colour_of(c) : "#222222")
            << "' front\n";
  }
  if (plot.shaded_below > 0)
    out << "set object rectangle from graph 0, graph 0 to graph 1, first " << plot.shaded_below
        << " fc rgb '#f0f0f0' fs solid noborder behind\n";
  const bool below = plot.key.rfind("below", 0) == 0;
  out << "set encoding utf8\nset border 3 lw 1 lc rgb '#444444'\nset tics nomirror out\n"
      << "set grid lw 1 dt 1 lc rgb '#dddddd'\nset key " << plot.key << (below ? "" : " opaque")
      << " samplen 2 spacing " << (below ? 1.0 : 1.2) << "\n"
      << "set title " << gnuplot_string(plot.title)
      << "\nset xlabel "
      // An empty line separates the label from a legend below it.
      << gnuplot_string(plot.x_label + (below ? "\n " : "")) << "\nset ylabel " << gnuplot_string(plot.y_label) << '\n';
  for (const auto& [axis, log, range] :
       { std::tuple{ 'x', plot.x_log, plot.x_range }, std::tuple{ 'y', plot.y_log, plot.y_range } })
  {
    if (log)
      out << "set logscale " << axis << '\n';
    if (range[0] != range[1])
      out << "set " << axis << "range [" << range[0] << ':' << range[1] << "]\n";
  }
  for (const auto& [axis, ticks] : { std::pair("x", plot.x_ticks), std::pair("y", plot.y_ticks) })
    for (std::size_t t = 0; t < ticks.size(); ++t)
      out << (t ? ", " : std::string("set ") + axis + "tics (") << ticks[t] << (t + 1 == ticks.size() ? ")\n" : "");
  for (std::size_t t = 0; t < plot.x_names.size(); ++t)
    // Percent signs are doubled, because gnuplot reads tick labels as format strings.
    out << (t ? ", " : "set xtics rotate by 25 right (") << replaced(gnuplot_string(plot.x_names[t]), "%", "%%") << ' '
        << t << (t + 1 == plot.x_names.size() ? ")\nset boxwidth 0.6\nset lmargin 16\nset bmargin 7\n" : "");
  const auto draw = [&](const std::string& terminal, const std::string& file)
  {
    out << "set terminal " << terminal << "\nset output " << gnuplot_string(file) << "\nplot ";
    for (std::size_t c = 0; c < plot.curves.size(); ++c)
      out << (c ? ", " : "") << "$curve" << c << ' ' << style_of(plot.curves[c], c)
          << (plot.curves[c].name.empty() ? " notitle" : " title " + gnuplot_string(plot.curves[c].name));
    out << "\nset output\n";
  };
  const std::string size = fmt::format(" noenhanced size {},{}", plot.width, plot.height);
  draw("pngcairo" + size + " font 'sans,13' background '#ffffff'", path + ".png");
  draw("svg" + size + " font 'sans,15' background '#ffffff'", path + ".svg");
  return out.str();
}

}  // namespace

// Single quotes are doubled inside of single quotes; a line break needs double quotes.
std::string gnuplot_string(const std::string& text)
{
  return "'" + replaced(replaced(text, "'", "''"), "\n", "'.\"\\n\".'") + "'";
}

void run_gnuplot(const std::string& commands, const std::string& path)
{
  const std::string file = path + ".gnuplot", messages = path + ".log";
  write_text(file, commands);
  if (std::system("command -v gnuplot >/dev/null 2>&1") != 0)
    throw Error("plot " + path +
                ": the program gnuplot is missing (Debian's package gnuplot-nox); its commands are in " + file);
  const auto word = [](const std::string& name) { return "'" + replaced(name, "'", "'\\''") + "'"; };
  const bool drawn = std::system(("gnuplot " + word(file) + " 2>" + word(messages) + " >&2").c_str()) == 0;
  std::ifstream log(messages);
  const std::string said{ std::istreambuf_iterator<char>(log), std::istreambuf_iterator<char>() };
  std::filesystem::remove(messages);
  if (!drawn)
    throw Error("plot " + path + ": gnuplot failed on " + file + ": " + said);
  std::filesystem::remove(file);
}

void write_plot(const Plot& plot, const std::string& path) { run_gnuplot(script(plot, path), path); }

std::string write_plots(const Plots& plots, const std::string& folder)
{
  const std::filesystem::path place(folder);
  std::string lines;
  for (const auto& [file, plot] : plots)
  {
    write_plot(plot, (place / file).string());
    lines += "\n![" + plot.title + "](" + place.filename().string() + "/" + file + ".png)\n";
  }
  return lines;
}

}  // namespace frontalis
