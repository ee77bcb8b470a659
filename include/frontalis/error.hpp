#pragma once

#include <stdexcept>
#include <string>

namespace frontalis
{

/// The library's only exception type. Its text names the file, line or key, what was found and what would be right.
class Error : public std::runtime_error
{
public:
  explicit Error(const std::string& what) : std::runtime_error(what) {}
};

}  // namespace frontalis
