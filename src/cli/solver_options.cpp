#include "cli/solver_options.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>

namespace frontalis
{

void add_backend_option(CLI::App& command, std::string& backend, std::vector<std::string> names)
{
  command.add_option("--backend", backend, "the solver's implementation (" + backend + ")")
      ->check(CLI::IsMember(std::move(names)));
}

std::vector<std::string> named_backends()
{
  std::vector<std::string> names = backend_names();
  names.erase(std::remove(names.begin(), names.end(), name_of("auto")), names.end());
  return names;
}

SolverSettings SolverOptions::settings() const
{
  SolverSettings settings;
  settings.backend = backend_from_name(backend);
  settings.threads = threads;
  return settings;
}

void add_solver_options(CLI::App& command, SolverOptions& options)
{
  add_backend_option(command, options.backend);
  command.add_option("--threads", options.threads, "CPU threads (0: one per core)")->check(CLI::Range(0, 1024));
}

}  // namespace frontalis
