#pragma once

#include "solver/cpu/shell_kernel_body.hpp"
#include "solver/cpu/simd_number.hpp"

namespace frontalis
{

/// Lanes of an instruction set.
template <class Architecture>
struct ShellLanes
{
  using Real = float;
  using Batch = xsimd::batch<float, Architecture>;
  static constexpr int count = static_cast<int>(Batch::size);

  static FRONTALIS_LAW Batch load(const float* p) { return Batch::load_unaligned(p); }
  static FRONTALIS_LAW Batch gather(const float* p, const std::int32_t* index)
  {
    return Batch::gather(p, xsimd::batch<std::int32_t, Architecture>::load_unaligned(index));
  }
  static FRONTALIS_LAW void store(const Batch& x, float* p) { x.store_unaligned(p); }
};

}  // namespace frontalis
