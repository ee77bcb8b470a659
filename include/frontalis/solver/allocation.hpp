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

/// Lists arrays that are not empty: vectors in host memory by their capacity, arrays of a device by their bytes.
class AllocationList
{
public:
  template <class T>
  void add(Effect effect, const std::string& what, const std::vector<T>& array)
  {
    add(effect, what, array.capacity() * sizeof(T));
  }
  void add(Effect effect, const std::string& what, std::size_t bytes)
  {
    if (bytes > 0)
      list_.push_back({ effect, what, bytes });
  }
  std::vector<Allocation> take() { return std::move(list_); }

private:
  std::vector<Allocation> list_;
};

}  // namespace frontalis
