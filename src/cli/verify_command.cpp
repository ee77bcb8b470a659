#include "cli/chosen_cases.hpp"
#include "cli/interrupt.hpp"

#include "frontalis/error.hpp"
#include "frontalis/study/verification.hpp"

#include <CLI/CLI.hpp>

#include <chrono>
#include <cstdio>
#include <memory>

namespace frontalis
{
namespace
{

struct VerifyOptions
{
  std::vector<std::string> only;
  std::string backend = "cpu";
  std::string json, markdown;
  bool quick = false;
};

void verify(const VerifyOptions& options)
{
  const auto cases = chosen_cases(verification_cases(), options.only, !options.quick);
  const VerificationSettings settings{ backend_from_name(options.backend) };
  Findings findings;
  int failed = 0, bounded = 0;
  double seconds = 0;
  std::printf("%-17s %-44s %12s %12s %-6s %10s %8s\n", "case", "check", "expected", "got", "unit", "error", "bound");
  for (const auto& c : cases)
  {
    const auto start = std::chrono::steady_clock::now();
    Finding finding = c.run(settings);
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    for (const auto& check : finding.checks)
    {
      std::printf("%s\n", check_line(c.name, check).c_str());
      bounded += check.bound == check.bound ? 1 : 0;
      failed += check.passed() ? 0 : 1;
    }
    if (!finding.skipped.empty())
      std::printf("%-17s skipped: %s\n", c.name.c_str(), finding.skipped.c_str());
    std::fflush(stdout);
    findings.emplace_back(c.name, std::move(finding));
    if (interrupt_requested())
      throw Interrupted();
  }
  if (!options.json.empty())
    write_text(options.json, findings_json(findings));
  if (!options.markdown.empty())
    write_manual(findings, options.markdown);
  if (failed > 0)
    throw Error(std::to_string(failed) + " of " + std::to_string(bounded) + " checks failed");
  std::printf("all %d checks passed in %.0f s\n", bounded, seconds);
}

}  // namespace

void add_verify_command(CLI::App& app, Action& action)
{
  auto options = std::make_shared<VerifyOptions>();
  CLI::App* command =
      app.add_subcommand("verify", "compare the solver with closed forms, published figures and CalculiX");
  command->add_option("--only", options->only, "cases to run, by name");
  command->add_flag("--quick", options->quick, "without the cases that take longer");
  command->add_option("--backend", options->backend, "of the motions: reference, cpu or cuda (cpu)")
      ->check(CLI::IsMember({ "reference", "cpu", "cuda" }));
  command->add_option("--json", options->json, "write the figures to this file");
  command->add_option("--markdown", options->markdown,
                      "write the manual to this file, its plots to a folder of its name");
  command->callback([options, &action] { action = [options] { verify(*options); }; });
}

}  // namespace frontalis
