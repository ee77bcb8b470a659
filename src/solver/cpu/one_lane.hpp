#pragma once

#include "frontalis/physics/number.hpp"

#include <cstdint>

namespace frontalis
{

/// Lanes of a kernel without SIMD.
template <class Number>
struct OneLane
{
  using Real = Number;
  using Batch = Number;
  static constexpr int count = 1;

  static FRONTALIS_LAW Number load(const Number* p) { return *p; }
  static FRONTALIS_LAW Number gather(const Number* p, const std::int32_t* index) { return p[*index]; }
  static FRONTALIS_LAW void store(Number x, Number* p) { *p = x; }
};

}  // namespace frontalis
