#include "cli/command.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

namespace
{

volatile std::sig_atomic_t requested = 0, ends_at_once = 0;

// The first Ctrl-C or SIGTERM only sets the flag, unless ends_at_once is set; the second one ends the program at once.
void catch_interrupts()
{
  struct sigaction action = {};
  action.sa_handler = [](int)
  {
    requested = 1;
    if (ends_at_once != 0)
      _exit(frontalis::exit_interrupted);
  };
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

int report(const std::string& text, int code)
{
  std::fprintf(stderr, "%s\n", text.c_str());
  return code;
}

}  // namespace

bool frontalis::interrupt_requested() { return requested != 0; }

void frontalis::end_at_interrupt()
{
  ends_at_once = 1;
  if (interrupt_requested())
    throw Interrupted();
}

int main(int argc, char** argv)
{
  CLI::App app("frontalis: simulates facial soft tissue", "frontalis");
  app.set_version_flag("--version", "frontalis " FRONTALIS_VERSION);
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::simple);
  frontalis::add_bake_command(app);
  frontalis::add_run_command(app);
  frontalis::add_bench_command(app);
  frontalis::add_effects_command(app);
  frontalis::add_verify_command(app);
  frontalis::add_faces_command(app);
  frontalis::add_dataset_command(app);
  frontalis::add_gltf_command(app);
  frontalis::add_rest_command(app);
  frontalis::add_fit_command(app);
  frontalis::add_retarget_command(app);
  frontalis::add_calibrate_command(app);
  frontalis::add_accuracy_command(app);
  frontalis::add_stability_command(app);

  std::vector<std::string> commands;
  for (const CLI::App* const command : app.get_subcommands([](const CLI::App*) { return true; }))
    commands.push_back(command->get_name());
  if (argc > 1 && argv[1][0] != '-' && std::find(commands.begin(), commands.end(), argv[1]) == commands.end())
    return report(fmt::format("there is no command '{}'; the commands are {}", argv[1], fmt::join(commands, ", ")),
                  frontalis::exit_wrong_usage);

  catch_interrupts();
  try
  {
    app.parse(argc, argv);
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
      return report("the standard output could not be written whole; is the disk full or the reader gone?",
                    frontalis::exit_error);
    return frontalis::exit_success;
  }
  catch (const CLI::ParseError& error)
  {
    // --help and --version are exceptions too, with code 0.
    return app.exit(error) == 0 ? frontalis::exit_success : frontalis::exit_wrong_usage;
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
    return report("out of memory; use larger voxels or a smaller region, and check the scene's 'unit'",
                  frontalis::exit_error);
  }
  catch (const std::exception& error)
  {
    return report(error.what(), frontalis::exit_error);
  }
}
