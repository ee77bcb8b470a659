#include "cli/command.hpp"
#include "cli/interrupt.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <exception>

namespace
{

int report(const char* text, int code)
{
  std::fprintf(stderr, "%s\n", text);
  return code;
}

}  // namespace

int main(int argc, char** argv)
{
  CLI::App app("frontalis: simulates facial soft tissue", "frontalis");
  app.set_version_flag("--version", "frontalis " FRONTALIS_VERSION);
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::simple);

  frontalis::Action action;
  frontalis::add_bake_command(app, action);
  frontalis::add_run_command(app, action);
  frontalis::add_bench_command(app, action);
  frontalis::add_effects_command(app, action);
  frontalis::add_verify_command(app, action);
  frontalis::add_accuracy_command(app, action);
  frontalis::add_stability_command(app, action);

  try
  {
    app.parse(argc, argv);
  }
  catch (const CLI::ParseError& error)
  {
    // --help and --version are exceptions too, with code 0
    return app.exit(error) == 0 ? frontalis::exit_success : frontalis::exit_wrong_usage;
  }

  frontalis::catch_interrupts();
  try
  {
    action();
    return frontalis::exit_success;
  }
  catch (const frontalis::Interrupted&)
  {
    return report("interrupted", frontalis::exit_interrupted);
  }
  catch (const frontalis::WrongUsage& error)
  {
    return report(error.what(), frontalis::exit_wrong_usage);
  }
  catch (const std::bad_alloc&)
  {
    return report("out of memory; use larger voxels or a smaller region", frontalis::exit_error);
  }
  catch (const std::exception& error)
  {
    return report(error.what(), frontalis::exit_error);
  }
}
