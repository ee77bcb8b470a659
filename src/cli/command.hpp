#pragma once

#include <stdexcept>

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

/// Thrown for options that are wrong or do not go together.
class WrongUsage : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// Thrown when Ctrl-C ends the work early.
struct Interrupted
{
};

/// Whether Ctrl-C or SIGTERM was received once; a second one ends the program.
bool interrupt_requested();

/// From now on, the first Ctrl-C or SIGTERM ends the program: for work whose output is flushed as it is made, and whose
/// files are written at the end. Throws Interrupted if one was received before.
void end_at_interrupt();

// One function per subcommand. It declares the options in `app`, and the work to be done once the command line has been
// read. The work throws Error, WrongUsage or Interrupted.
void add_accuracy_command(CLI::App& app);
void add_bake_command(CLI::App& app);
void add_bench_command(CLI::App& app);
void add_dataset_command(CLI::App& app);
void add_effects_command(CLI::App& app);
void add_faces_command(CLI::App& app);
void add_fit_command(CLI::App& app);
void add_gltf_command(CLI::App& app);
void add_rest_command(CLI::App& app);
void add_retarget_command(CLI::App& app);
void add_calibrate_command(CLI::App& app);
void add_run_command(CLI::App& app);
void add_stability_command(CLI::App& app);
void add_verify_command(CLI::App& app);

}  // namespace frontalis
