#pragma once

#include "frontalis/physics/distance_field.hpp"

#include <cstddef>

namespace frontalis
{

/// Fetches an object into the cache, if its address is valid. `to_write`: it will be written next.
template <bool to_write = false, class Object>
FRONTALIS_LAW void prefetch(const Object* object)
{
  constexpr std::size_t line = 64;
  const char* const bytes = reinterpret_cast<const char*>(object);
  for (std::size_t at = 0; at < sizeof(Object); at += line)
    __builtin_prefetch(bytes + at, to_write ? 1 : 0);
}

/// Fetches the samples around a cell into the cache; `first` is what DistanceField::around() returned.
FRONTALIS_LAW void prefetch_samples(const float* first)
{
  constexpr int row = physics::DistanceField::brick_row;
  if (first == nullptr)
    return;
  for (int plane = 0; plane < 3; ++plane)
    for (int of = 0; of < 3; ++of)
      __builtin_prefetch(first + (plane * row + of) * row);
}

}  // namespace frontalis
