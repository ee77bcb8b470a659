#include "cli/command_options.hpp"

#include <cmath>
#include <filesystem>

namespace frontalis
{

void add_backend_option(CLI::App& command, Backend& backend, bool automatic)
{
  std::vector<Backend> names = backend_names();
  if (!automatic)
    names.erase(std::remove(names.begin(), names.end(), "auto"), names.end());
  command.add_option("--backend", backend, "the solver's implementation (" + backend + ")")
      ->check(CLI::IsMember(std::move(names)));
}

void add_solver_options(CLI::App& command, SolverSettings& settings)
{
  add_backend_option(command, settings.backend, true);
  command.add_option("--threads", settings.threads, "CPU threads at most (0: one per core)")
      ->check(CLI::Range(0, 1024));
}

CLI::Option* add_ramp(CLI::App& command, double& seconds, const std::string& text)
{
  const auto fault = [](const std::string& given)
  {
    double number = 0;
    const bool allowed = CLI::detail::lexical_cast(given, number) && number >= 0 && std::isfinite(number);
    return allowed ? std::string() : given + " is not a finite number from 0";
  };
  return command.add_option("--ramp", seconds, text)->check(fault, "NONNEGATIVE");
}

std::vector<std::filesystem::path> package_places(const std::string& shared, const std::string& bundled,
                                                  const std::string& source)
{
  std::error_code none;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", none).parent_path();
  return { program / "../share/frontalis" / shared, program / "../../share/frontalis" / shared,
           program / ".." / bundled, std::filesystem::path(FRONTALIS_SOURCE_DIRECTORY) / source };
}

void check_seconds(double seconds)
{
  if (!(seconds > 0) || !std::isfinite(seconds))
    throw WrongUsage("--seconds: must be a number greater than 0");
}

std::string plot_path(const std::string& option)
{
  std::filesystem::path path = option;
  if (!option.empty() && path.extension() != ".png")
    throw WrongUsage("--plot: '" + option + "' must end in .png");
  return path.replace_extension().string();
}

}  // namespace frontalis
