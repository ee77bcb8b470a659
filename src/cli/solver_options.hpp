#pragma once

#include "frontalis/solver/solver.hpp"

#include <string>
#include <vector>

namespace CLI
{
class App;
}

namespace frontalis
{

/// Declares --backend, one of `names`; its default is what `backend` holds.
void add_backend_option(CLI::App& command, std::string& backend, std::vector<std::string> names = backend_names());

/// Those that must be named: all but "auto".
std::vector<std::string> named_backends();

/// What the command line says about the solver.
struct SolverOptions
{
  std::string backend = "auto";
  int threads = 0;

  SolverSettings settings() const;
};

/// Declares --backend and --threads.
void add_solver_options(CLI::App& command, SolverOptions& options);

}  // namespace frontalis
