#pragma once

#include "cli/command.hpp"

#include "frontalis/solver/solver.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace frontalis
{

// Options that several subcommands share.

/// Declares an option whose value must be a finite number above 0.
template <class Value>
CLI::Option* add_positive(CLI::App& command, const std::string& name, Value& value, const std::string& text)
{
  const auto fault = [](const std::string& given)
  {
    double number = 0;
    const bool allowed = CLI::detail::lexical_cast(given, number) && number > 0 && std::isfinite(number);
    return allowed ? std::string() : given + " is not a finite number above 0";
  };
  return command.add_option(name, value, text)->check(fault, "POSITIVE");
}

/// Declares --ramp, whose value must be a finite number from 0.
CLI::Option* add_ramp(CLI::App& command, double& seconds, const std::string& text);

/// Declares --backend, whose default is the value of `backend`. `automatic`: whether "auto" is allowed.
void add_backend_option(CLI::App& command, Backend& backend, bool automatic);

/// Declares --backend and --threads.
void add_solver_options(CLI::App& command, SolverSettings& settings);

/// Places at which a file or folder of the package may be: installed (share/ beside bin/ or lib/frontalis/), bundled,
/// or in the sources.
std::vector<std::filesystem::path> package_places(const std::string& shared, const std::string& bundled,
                                                  const std::string& source);

/// Throws WrongUsage if --seconds is not a number greater than 0.
void check_seconds(double seconds);

/// The path of --plot FILE.png without its extension, for write_plot(); empty if the option is not given. Throws
/// WrongUsage on an extension other than .png.
std::string plot_path(const std::string& option);

/// The cases that `only` names, in the order of `cases`. If `only` is empty: the short cases, or all cases with `all`.
/// Throws WrongUsage on a name that no case has.
template <class Case>
std::vector<Case> chosen_cases(std::vector<Case> cases, const std::vector<std::string>& only, bool all)
{
  std::string names;
  for (const Case& c : cases)
    names += " " + c.name;
  for (const std::string& name : only)
    if (std::none_of(cases.begin(), cases.end(), [&](const Case& c) { return c.name == name; }))
      throw WrongUsage("--only: there is no case '" + name + "'; there are" + names);
  const auto left_out = [&](const Case& c)
  { return only.empty() ? !all && !c.quick : std::find(only.begin(), only.end(), c.name) == only.end(); };
  cases.erase(std::remove_if(cases.begin(), cases.end(), left_out), cases.end());
  return cases;
}

}  // namespace frontalis
