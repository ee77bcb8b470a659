#pragma once

#include "cli/command.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace frontalis
{

/// The cases that `only` names, in the order of `cases`; if it is empty, the short cases, or all cases with `all`.
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
