#pragma once

#include "cli/command.hpp"

#include <string>

namespace frontalis
{

/// The path of --plot FILE.png without its extension, for write_plot(); empty without the option. Throws WrongUsage on
/// another extension.
inline std::string plot_path(const std::string& option)
{
  const std::string extension = ".png";
  if (option.empty())
    return option;
  if (option.size() <= extension.size() ||
      option.compare(option.size() - extension.size(), extension.size(), extension) != 0)
    throw WrongUsage("--plot: '" + option + "' must end in .png");
  return option.substr(0, option.size() - extension.size());
}

}  // namespace frontalis
