#pragma once

#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>

namespace CLI
{
class App;
}

namespace frontalis
{

/// Exit codes of the program.
enum ExitCode : int
{
  exit_success = 0,
  exit_error = 1,         ///< an Error, with its text on stderr
  exit_wrong_usage = 2,   ///< wrong options, with the reason on stderr
  exit_interrupted = 130  ///< Ctrl-C; no file is left half written
};

/// Options that are wrong, or that do not go together.
class WrongUsage : public std::runtime_error
{
public:
  explicit WrongUsage(const std::string& what) : std::runtime_error(what) {}
};

/// Throws WrongUsage if --seconds is not a number greater than 0.
inline void check_seconds(double seconds)
{
  if (!(seconds > 0) || !std::isfinite(seconds))
    throw WrongUsage("--seconds: must be a number greater than 0");
}

/// The work of a subcommand, done after the command line has been read; throws Error, WrongUsage or Interrupted.
using Action = std::function<void()>;

// One function per subcommand: it declares the options in `app` and sets `action` where the subcommand is chosen.
void add_accuracy_command(CLI::App& app, Action& action);
void add_bake_command(CLI::App& app, Action& action);
void add_bench_command(CLI::App& app, Action& action);
void add_effects_command(CLI::App& app, Action& action);
void add_run_command(CLI::App& app, Action& action);
void add_stability_command(CLI::App& app, Action& action);
void add_verify_command(CLI::App& app, Action& action);

}  // namespace frontalis
