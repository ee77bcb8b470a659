#pragma once

#include "frontalis/effect.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace frontalis
{

/// Bytes that a solver's arrays hold for an effect.
struct Allocation
{
  Effect effect;
  std::string what;
  std::size_t bytes;
};

}  // namespace frontalis
