// Presents the findings of a study of accuracy as a table, a plot, a text and profiles for scene files.

#include "study/accuracy/accuracy_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace frontalis
{
namespace
{

double mm(double metres) { return 1e3 * metres; }

// A curve of the rows that have an error and a cost, cheapest first. `label` returns the text beside a point.
Plot::Curve curve_of(
    const AccuracyFindings& findings, std::vector<std::size_t> rows, const std::string& name, Plot::Style style,
    const std::function<std::string(const AccuracyRow&)>& label = [](const AccuracyRow&) { return std::string(); })
{
  const auto& all = findings.rows;
  const auto has_figures = [&](std::size_t r) { return all[r].error.rms > 0 && all[r].cost > 0; };
  rows.erase(std::partition(rows.begin(), rows.end(), has_figures), rows.end());
  std::sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) { return all[a].cost < all[b].cost; });
  Plot::Curve curve{ name, {}, {}, style };
  for (const std::size_t r : rows)
  {
    curve.add(all[r].cost, mm(all[r].error.rms));
    curve.labels.push_back(label(all[r]));
  }
  return curve;
}

std::string reference_words(const AccuracyFindings& f)
{
  if (f.closed_form)
    return "Settled skins are compared with the closed form.";
  const std::string text = fmt::format(
      "The reference has voxels of {}, assumed-strain hourglass control and no scaled mass. Its own error is "
      "about {}, and nothing below that is claimed. This estimate is ",
      millimetres(f.reference.profile.voxel[0], 2), millimetres(f.reference_error, 2));
  if (is_credible(f.order))
    return text + fmt::format("Richardson's extrapolation with the observed order of {:.2g}.", f.order);
  const std::string why = std::isnan(f.order)
                              ? "the finest three solutions show no order of convergence"
                              : fmt::format("the observed order of {:.2g} is outside 0.5 to 2.5", f.order);
  return text + "Richardson's extrapolation with the cautious order of 0.5, since " + why +
         " (boundaries that are staircases converge unevenly).";
}

}  // namespace

Table accuracy_table(const AccuracyFindings& findings)
{
  Table table({ "setting", "front", "error RMS [mm]", "error max [mm]", "settled RMS [mm]", "settled max [mm]",
                "landmark [mm]", "energy [%]", "cost [s/s]", "spread [%]", "step [us]", "steps/s", "voxels",
                "memory [MB]", "build [s]", "state", "averaged RMS [mm]" });
  for (std::size_t r = 0; r < findings.rows.size(); ++r)
  {
    const AccuracyRow& row = findings.rows[r];
    const bool best = std::find(findings.front.begin(), findings.front.end(), r) != findings.front.end();
    const auto three = [](double value) { return std::isnan(value) ? value : std::stod(readable(value, 3)); };
    table.add({ row.name, best ? "*" : "", three(mm(row.error.rms)), three(mm(row.error.largest)),
                three(mm(row.settled.rms)), three(mm(row.settled.largest)), three(mm(row.landmark)),
                three(100 * row.energy), three(row.cost), three(100 * row.spread), three(1e6 * row.step),
                three(row.steps), row.voxels, three(1e-6 * row.memory), three(row.build),
                row.fault.empty() ? (row.is_noisy() ? "noisy" : "") : row.fault, three(mm(row.averaged)) });
  }
  return table;
}

Plot accuracy_plot(const AccuracyFindings& findings, const std::string& title)
{
  Plot plot{ title + "\n" + findings.machine, "wall seconds per simulated second", "error of the skin, RMS [mm]" };
  plot.x_log = plot.y_log = true;
  plot.width = 900;
  plot.height = 680;
  std::vector<std::size_t> every_row(findings.rows.size());
  std::iota(every_row.begin(), every_row.end(), 0);
  const Plot::Curve all = curve_of(findings, every_row, "all settings", Plot::Style::faint);
  if (all.x.empty())
    return plot;
  plot.curves = { all };
  const auto [low, high] = std::minmax_element(all.y.begin(), all.y.end());
  const double own = mm(findings.reference_error);
  plot.x_range = { std::min(all.x.front() / 1.6, 0.7), std::max(all.x.back() * 1.6, 1.5) };
  plot.y_range = { (own > 0 ? std::min(*low, own) : *low) / 1.3, *high * 1.3 };
  plot.shaded_below = own;
  for (double decade = 1e-6; decade < 1e6; decade *= 10)
    for (const double step : { 1.0, 1.5, 2.0, 3.0, 5.0, 7.0 })
    {
      const double tick = decade * step;
      if (tick >= plot.y_range[0] && tick <= plot.y_range[1])
        plot.y_ticks.push_back(tick);
      if (tick >= plot.x_range[0] && tick <= plot.x_range[1] && (step == 1 || step == 2 || step == 5))
        plot.x_ticks.push_back(tick);
    }
  const auto edge_of = [](const AccuracyRow& row) { return millimetres(row.setting.profile.voxel[0], 2); };
  const auto style = Plot::Style::line_and_points;
  for (const KnobLine& line : findings.knobs)
  {
    Plot::Curve curve = line.knob == "voxel" ? curve_of(findings, line.rows, line.words, style, edge_of)
                                             : curve_of(findings, line.rows, line.words, style);
    curve.coloured_labels = true;
    if (curve.x.size() >= 2)
      plot.curves.push_back(std::move(curve));
  }
  plot.curves.push_back(curve_of(findings, findings.front, "Pareto front", Plot::Style::strong));
  // Points are numbered; the legend names their settings.
  for (std::size_t p = 0; p < findings.front.size(); ++p)
  {
    const AccuracyRow& row = findings.rows[findings.front[p]];
    const std::string number = fmt::to_string(p + 1);
    plot.curves.push_back({ number + ": " + row.name,
                            { row.cost },
                            { mm(row.error.rms) },
                            Plot::Style::strong,
                            { number },
                            "right offset -0.6,-0.8" });
  }
  if (own > 0)
    plot.curves.push_back({ "",
                            { plot.x_range[0], plot.x_range[1] },
                            { own, own },
                            Plot::Style::guide,
                            { "error of the reference" },
                            "left offset 0.7,-0.7" });
  plot.curves.push_back({ "", { 1, 1 }, { plot.y_range[0], plot.y_range[1] }, Plot::Style::guide, { "real time" } });
  std::size_t longest = 0;
  for (const Plot::Curve& curve : plot.curves)
    longest = std::max(longest, curve.name.size());
  // A negative width compensates gnuplot's overestimate of the width of the legend's text.
  plot.key = fmt::format("below Left reverse maxrows 10 maxcols 3 width {} font ',12'", longest > 24 ? -8 : -4);
  return plot;
}

std::string accuracy_report(const AccuracyFindings& f, const std::string& title)
{
  const std::string phases =
      f.closed_form
          ? "*error* is the error of the settled skin. "
          : "*error* is the error of the skin in the worst phase of the history (half of the ramp, its end, the "
            "end of the history, settled), and *settled* that of the settled skin alone. *averaged* is the "
            "error of displacements averaged by a Gaussian of " +
                millimetres(f.averaged_over, 2) + " on the skin, which takes folds out. ";
  std::string out =
      "# " + title + "\n\n" + reference_words(f) + " The skin moves by " + millimetres(f.motion, 2) + " RMS. " +
      phases +
      "*landmark* is the error of the worst landmark, and *energy* the imbalance of the energy ledger. "
      "*cost* is wall seconds per simulated second, from the median of repeated timings, and *spread* the "
      "distance of their quartiles. Stars mark the Pareto front: no other setting is both cheaper and more "
      "accurate. Machine: " +
      f.machine + ".\n";
  for (const std::string& note : f.notes)
    out += "\n- " + note;
  const auto noisy = std::count_if(f.rows.begin(), f.rows.end(), [](const auto& row) { return row.is_noisy(); });
  if (noisy > 0)
    out += fmt::format(
        "\n- The machine was disturbed while {} settings were timed (spread above 20 %, or other programs "
        "took a fifth of the processors). Those are marked noisy; the same command times them again.",
        noisy);
  return wrapped(out + "\n\n" + accuracy_table(f).markdown());
}

std::string profile_text(const AccuracyRow& row, const std::string& name, const std::string& machine)
{
  const AccuracyProfile& p = row.setting.profile;
  const AccuracyProfile defaults;
  std::string voxel = readable(mm(p.voxel[0]), 6) + " mm";
  if (p.voxel[1] != p.voxel[0] || p.voxel[2] != p.voxel[0])
    voxel = "[" + voxel + ", " + readable(mm(p.voxel[1]), 6) + " mm, " + readable(mm(p.voxel[2]), 6) + " mm]";
  std::string text = name + ": {voxel: " + voxel;
  const auto add = [&text](bool differs, const std::string& entry) { text += differs ? ", " + entry : ""; };
  add(p.samples != defaults.samples, fmt::format("samples: {}", p.samples));
  add(p.fill_min != defaults.fill_min, "fill_min: " + readable(p.fill_min));
  add(p.time_step_share != defaults.time_step_share, "time_step_share: " + readable(p.time_step_share));
  add(p.time_step != defaults.time_step, "time_step: " + p.time_step);
  add(p.boundary != defaults.boundary, "boundary: " + p.boundary);
  add(p.gaps != defaults.gaps, "gaps: " + p.gaps);
  add(p.fibres != defaults.fibres, "fibres: " + p.fibres);
  add(p.assumed_strain, "hourglass: assumed_strain");
  add(p.integration != defaults.integration, "integration: " + p.integration);
  add(p.precision != defaults.precision, "precision: " + p.precision);
  add(p.bulk_modulus_max > 0, "bulk_modulus_max: " + readable(1e-3 * p.bulk_modulus_max, 4) + " kPa");
  const MassScaling& mass = p.mass_scaling;
  if (mass.kind == MassScaling::Kind::uniform)
    text += ", mass_scaling: {uniform: " + readable(mass.factor) +
            (mass.in_motion > 0 ? ", in_motion: " + readable(1e6 * mass.in_motion) + " us}" : "}");
  else if (mass.kind == MassScaling::Kind::selective)
  {
    std::vector<std::string> entries;
    if (!mass.materials.empty())
      entries.push_back(fmt::format("selective: [{}]", fmt::join(mass.materials, ", ")));
    if (mass.time_step > 0)
      entries.push_back("time_step: " + readable(1e6 * mass.time_step) + " us");
    text += fmt::format(", mass_scaling: {{{}}}", fmt::join(entries, ", "));
  }
  return text + ", measured: {error: " + readable(mm(row.error.rms), 3) + " mm, cost: " + readable(row.cost, 3) +
         ", machine: \"" + machine + "\"}}";
}

}  // namespace frontalis
