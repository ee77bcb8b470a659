#pragma once

#include <stdexcept>
#include <string>

namespace frontalis
{

/// Base of the library's exceptions. The text names the file, line or key, what was found and what would be right.
class Error : public std::runtime_error
{
public:
  explicit Error(const std::string& what) : std::runtime_error(what) {}
};

}  // namespace frontalis
