#include "cli/accuracy_subject.hpp"
#include "cli/command.hpp"

#include "frontalis/error.hpp"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <memory>

#ifdef FRONTALIS_WITH_BAKE
#include "cli/interrupt.hpp"
#include "cli/progress.hpp"

#include <cstdio>
#endif

namespace frontalis
{
namespace
{

#ifdef FRONTALIS_WITH_BAKE

std::string time_text(double seconds)
{
  return seconds < 90 ? fmt::format("{:.0f} s", seconds) : fmt::format("{:.0f} min", seconds / 60);
}

void write_outputs(const AccuracyFindings& findings, const AccuracyOptions& options, const std::string& title)
{
  const std::string path = options.folder + "/accuracy";
  const Table table = accuracy_table(findings);
  const std::string report = accuracy_report(findings, title);
  write_text(path + ".csv", table.csv());
  write_text(path + ".json", table.json());
  write_text(path + ".md", report + "\n![" + title + "](accuracy.png)\n");
  // the paragraphs of the report between its title and its table
  const std::size_t begin = report.find("\n\n") + 2;
  fmt::print("\n{}\nreference {}\n\nwritten   {}.csv, .json, .md", table.text(),
             report.substr(begin, report.find("\n\n|") - begin), path);
  try
  {
    write_plot(accuracy_plot(findings, title), path);
    fmt::print(", .png, .svg\n");
  }
  catch (const Error& error)
  {
    fmt::print("\nno plot   {}\n", error.what());
  }
}

void choose(const AccuracyFindings& findings, const AccuracyOptions& options)
{
  if (options.tolerance <= 0 && options.time <= 0)
    return;
  const AccuracyRow& row = options.tolerance > 0 ? cheapest_within(findings, 1e-3 * options.tolerance)
                                                 : most_accurate_within(findings, options.time);
  const std::string profile = profile_text(row, "chosen", findings.machine);
  fmt::print("chosen    {}: error {:.3g} mm RMS, {:.3g} mm at most; {:.3g} s per simulated second{}\n\n  {}\n",
             row.name, 1e3 * row.error.rms, 1e3 * row.error.largest, row.cost,
             row.is_noisy() ? " (timed on a disturbed machine)" : "", profile);
  if (!options.save.empty())
  {
    write_text(options.save, fmt::format("# {}, as measured by: frontalis accuracy {}\n{}\n", row.name,
                                         options.source.path, profile));
    fmt::print("\nwritten   {0}; use it with --accuracy {0}\n", options.save);
  }
}

void study(AccuracyOptions options)
{
  if (options.tolerance > 0 && options.time > 0)
    throw WrongUsage("--tolerance and --time: only one of the two may be given");
  if (!options.save.empty() && options.tolerance <= 0 && options.time <= 0)
    throw WrongUsage("--save goes with --tolerance or --time");
  const AccuracySubject subject = accuracy_subject(options);

  Progress progress;
  int count = 0;
  std::string last;
  double left_then = 0;
  const AccuracyFindings findings = study_accuracy(
      subject.plan, subject.maker,
      [&](const std::string& stage, double done, double left)
      {
        if (stage != last || done == 0)
        {
          ++count;
          left_then = left;
        }
        last = stage;
        progress.update(
            fmt::format("{}: {}{}", count, stage, left_then > 0 ? ", then about " + time_text(left_then) : ""), done);
        return !interrupt_requested();
      });
  progress.clear();
  if (!findings.complete)
  {
    fmt::print(stderr, "finished settings are kept in {}; the same command goes on from there\n", options.folder);
    throw Interrupted();
  }
  write_outputs(findings, options, "Accuracy against time: " + subject.name);
  choose(findings, options);
}

#else

void study(const AccuracyOptions& options)
{
  throw Error(options.source.path +
              ": a study of accuracy bakes its models, and this program was built without baking");
}

#endif

}  // namespace

void add_accuracy_command(CLI::App& app, Action& action)
{
  auto options = std::make_shared<AccuracyOptions>();
  CLI::App* command = app.add_subcommand(
      "accuracy", "measure what each setting of a scene costs and how accurate it is, and choose one");
  command
      ->add_option("SCENE", options->source.path,
                   "scene file (YAML), or a body with a closed form: cantilever, stretched_block, active_bar")
      ->required();
  add_scene_options(*command, options->source);
  command
      ->add_option(
          "--knobs", options->knobs,
          "vary only these, without combinations: voxel, samples, fill_min, hourglass, integration, precision, "
          "share, time_step, mass_scaling, poisson, time_scaling, backend, profiles")
      ->delimiter(',');
  command->add_option("--voxels", options->voxels, "voxel edges, coarse to fine [mm]; the last is the reference's")
      ->delimiter(',')
      ->check(CLI::PositiveNumber);
  command->add_flag("--quick", options->quick, "fewer settings and a shorter motion, for a study of minutes");
  command
      ->add_option("--budget", options->budget,
                   "wall seconds that the study may take (280 with --quick, else all it needs)")
      ->check(CLI::PositiveNumber);
  command->add_option("--expression", options->expression, "the expression to activate (the scene's first one)");
  command->add_option("--ramp", options->ramp, "seconds over which activations grow (0.3)")->check(CLI::PositiveNumber);
  command->add_option("--hold", options->hold, "seconds for which they are held (0.3)")->check(CLI::PositiveNumber);
  auto* tolerance = command->add_option("--tolerance", options->tolerance,
                                        "choose the cheapest setting whose skin has at most this RMS error [mm]");
  tolerance->check(CLI::PositiveNumber);
  command
      ->add_option("--time", options->time,
                   "choose the most accurate setting that takes at most so many wall seconds per simulated second")
      ->check(CLI::PositiveNumber);
  command->add_option("--save", options->save, "write the chosen profile to this file, for --accuracy");
  command->add_option("-o,--output", options->folder, "folder for results and finished variants (accuracy_SCENE)");
  add_solver_options(*command, options->solver);
  command->callback([options, &action] { action = [options] { study(*options); }; });
}

}  // namespace frontalis
