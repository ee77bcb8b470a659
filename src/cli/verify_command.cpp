#include "cli/command_options.hpp"
#include "cli/model_source.hpp"

#include "frontalis/bake/bake.hpp"
#include "frontalis/error.hpp"
#include "frontalis/study/step_time.hpp"
#include "frontalis/study/verification.hpp"

#include <fmt/core.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

namespace frontalis
{
namespace
{

struct VerifyOptions
{
  std::vector<std::string> only;
  Backend backend = "cpu";
  std::string json, markdown;
  bool quick = false;
};

void verify(const VerifyOptions& options)
{
  check_output(options.json);
  check_output(options.markdown);
  if ((options.quick || !options.only.empty()) && std::filesystem::is_regular_file(options.markdown))
    throw WrongUsage("--markdown: " + options.markdown +
                     " would lose the cases that --only and --quick leave out; name a file that does not exist");
  BakeScene make_model;
#ifdef FRONTALIS_WITH_BAKE
  make_model = [](const Scene& scene) { return bake(scene); };
#endif
  const auto cases = chosen_cases(verification_cases(make_model), options.only, !options.quick);
  Findings findings;
  int failed = 0, bounded = 0;
  double seconds = 0;
  fmt::print("{}\n", check_heading());
  for (const auto& c : cases)
  {
    const double start = wall_seconds();
    Finding finding;
    c.run(options.backend, finding);
    seconds += wall_seconds() - start;
    for (const auto& check : finding.checks)
    {
      fmt::print("{}\n", check_line(c.name, check));
      bounded += std::isnan(check.bound) ? 0 : 1;
      failed += check.passed() ? 0 : 1;
    }
    if (!finding.skipped.empty())
      fmt::print("{:<17} skipped: {}\n", c.name, finding.skipped);
    std::fflush(stdout);
    findings.emplace_back(c.name, std::move(finding));
    if (interrupt_requested())
      break;
  }
  const bool interrupted = interrupt_requested();
  if (!options.json.empty())
    write_text(interrupted ? options.json + ".part" : options.json, findings_json(findings));
  if (interrupted)
    throw Interrupted();
  if (!options.markdown.empty())
    write_manual(findings, options.markdown);
  if (failed > 0)
    throw Error(fmt::format("{} of {} checks failed", failed, bounded));
  if (bounded == 0)
    throw Error("nothing was checked: the lines above say why cases were skipped");
  fmt::print("all {} checks passed in {:.0f} s\n", bounded, seconds);
}

}  // namespace

void add_verify_command(CLI::App& app)
{
  auto options = std::make_shared<VerifyOptions>();
  CLI::App* command =
      app.add_subcommand("verify", "compare the solver with closed forms, published figures and CalculiX");
  command->add_option("--only", options->only, "cases to run, by name");
  command->add_flag("--quick", options->quick, "leave out the cases that take longer than a few seconds");
  add_backend_option(*command, options->backend, false);
  command->add_option("--json", options->json, "write the figures to this file (FILE.part if interrupted)");
  command->add_option(
      "--markdown", options->markdown,
      "write the manual to this file, and its plots to a folder of the same name; with --only or --quick a "
      "new file");
  command->callback([options] { verify(*options); });
}

}  // namespace frontalis
