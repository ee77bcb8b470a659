#pragma once

#include <functional>
#include <stdexcept>
#include <string>

namespace CLI
{
class App;
}

namespace frontalis
{

/// What the program ends with.
enum ExitCode : int
{
  exit_success = 0,
  exit_error = 1,         ///< an Error; its text is on stderr
  exit_wrong_usage = 2,   ///< wrong options
  exit_interrupted = 130  ///< Ctrl-C; no half file is left
};

/// Options that each are right but do not go together.
class WrongUsage : public std::runtime_error
{
public:
  explicit WrongUsage(const std::string& what) : std::runtime_error(what) {}
};

/// What to do once the command line has been read; throws Error, WrongUsage or Interrupted.
using Action = std::function<void()>;

// one function a subcommand: declares its options in `app` and, where it is the one chosen, sets `action`
void add_accuracy_command(CLI::App& app, Action& action);
void add_bake_command(CLI::App& app, Action& action);
void add_bench_command(CLI::App& app, Action& action);
void add_effects_command(CLI::App& app, Action& action);
void add_run_command(CLI::App& app, Action& action);
void add_stability_command(CLI::App& app, Action& action);
void add_verify_command(CLI::App& app, Action& action);

}  // namespace frontalis
