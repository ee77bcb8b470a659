#include "cli/accuracy_subject.hpp"
#include "cli/command.hpp"

#include "frontalis/error.hpp"

#include <CLI/CLI.hpp>

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
  char text[32];
  std::snprintf(text, sizeof text, seconds < 90 ? "%.0f s" : "%.0f min", seconds < 90 ? seconds : seconds / 60);
  return text;
}

void write_outputs(const AccuracyFindings& findings, const AccuracyOptions& options, const std::string& title)
{
  const std::string path = options.folder + "/accuracy";
  const Table table = accuracy_table(findings);
  const std::string report = accuracy_report(findings, title);
  write_text(path + ".csv", table.csv());
  write_text(path + ".json", table.json());
  write_text(path + ".md", report + "\n![" + title + "](accuracy.png)\n");
  std::printf("\n%s", table.text().c_str());
  std::printf("\nreference %s\n",
              report.substr(report.find("\n\n") + 2, report.find("\n\n|") - report.find("\n\n") - 2).c_str());
  std::printf("\nwritten   %s.csv, .json, .md", path.c_str());
  try
  {
    write_plot(accuracy_plot(findings, title), path);
    std::printf(", .png, .svg\n");
  }
  catch (const Error& error)
  {
    std::printf("\nno plot   %s\n", error.what());
  }
}

void choose(const AccuracyFindings& findings, const AccuracyOptions& options)
{
  if (options.tolerance <= 0 && options.time <= 0)
    return;
  const AccuracyRow& row = options.tolerance > 0 ? cheapest_within(findings, 1e-3 * options.tolerance)
                                                 : most_accurate_within(findings, options.time);
  const std::string profile = profile_text(row, "chosen", findings.machine);
  std::printf("chosen    %s: error %.3g mm RMS, %.3g mm at most; %.3g s a simulated second%s\n\n  %s\n",
              row.name.c_str(), 1e3 * row.error.rms, 1e3 * row.error.largest, row.cost,
              row.noisy ? " (timed on a disturbed machine)" : "", profile.c_str());
  if (!options.save.empty())
  {
    write_text(options.save,
               "# " + row.name + ", as measured by: frontalis accuracy " + options.source.path + "\n" + profile + "\n");
    std::printf("\nwritten   %s; use it with --accuracy %s\n", options.save.c_str(), options.save.c_str());
  }
}

void study(AccuracyOptions options)
{
  if (options.tolerance > 0 && options.time > 0)
    throw WrongUsage("--tolerance and --time: one of the two");
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
            std::to_string(count) + ": " + stage + (left_then > 0 ? ", then about " + time_text(left_then) : ""), done);
        return !interrupt_requested();
      });
  progress.clear();
  if (!findings.complete)
  {
    std::fprintf(stderr, "what was finished is kept in %s; the same command goes on from there\n",
                 options.folder.c_str());
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
          "only these, without combinations: voxel, samples, fill_min, hourglass, integration, precision, share, "
          "time_step, mass_scaling, poisson, time_scaling, backend, profiles")
      ->delimiter(',');
  command->add_option("--voxels", options->voxels, "voxel edges, coarse to fine [mm]; the last is the reference's")
      ->delimiter(',')
      ->check(CLI::PositiveNumber);
  command->add_flag("--quick", options->quick, "fewer settings, a shorter motion: minutes");
  command
      ->add_option("--budget", options->budget,
                   "wall seconds that the study may take (280 with --quick, else all it needs)")
      ->check(CLI::PositiveNumber);
  command->add_option("--expression", options->expression, "what is activated (the scene's first expression)");
  command->add_option("--ramp", options->ramp, "seconds over which activations grow (0.3)")->check(CLI::PositiveNumber);
  command->add_option("--hold", options->hold, "seconds for which they are held (0.3)")->check(CLI::PositiveNumber);
  auto* tolerance = command->add_option("--tolerance", options->tolerance,
                                        "choose the cheapest setting with at most this error of the skin, RMS [mm]");
  tolerance->check(CLI::PositiveNumber);
  command
      ->add_option("--time", options->time,
                   "choose the most accurate setting of at most so many wall seconds a "
                   "simulated second")
      ->check(CLI::PositiveNumber);
  command->add_option("--save", options->save, "write the chosen profile to this file, for --accuracy");
  command->add_option("-o,--output", options->folder, "folder for results and finished variants (accuracy_SCENE)");
  command->add_option("--backend", options->backend, "auto, reference, cpu or cuda (auto)")
      ->check(CLI::IsMember({ "auto", "reference", "cpu", "cuda" }));
  command->add_option("--threads", options->threads, "CPU threads (0: one a core)")->check(CLI::Range(0, 1024));
  command->callback([options, &action] { action = [options] { study(*options); }; });
}

}  // namespace frontalis
