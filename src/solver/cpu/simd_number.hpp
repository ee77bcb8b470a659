#pragma once

#include "frontalis/physics/number.hpp"

#include <xsimd/xsimd.hpp>

namespace frontalis
{
namespace physics
{

/// A SIMD batch as the number type of a law, one voxel per lane.
template <class Architecture>
struct Number<xsimd::batch<float, Architecture>>
{
  using Batch = xsimd::batch<float, Architecture>;
  using Bool = typename Batch::batch_bool_type;

  static FRONTALIS_LAW Batch of(double value) { return Batch(static_cast<float>(value)); }
  static FRONTALIS_LAW Batch select(const Bool& condition, const Batch& yes, const Batch& no)
  {
    return xsimd::select(condition, yes, no);
  }
  static FRONTALIS_LAW Batch max(const Batch& a, const Batch& b) { return xsimd::max(a, b); }
  static FRONTALIS_LAW Batch min(const Batch& a, const Batch& b) { return xsimd::min(a, b); }
  static FRONTALIS_LAW Batch sqrt(const Batch& a) { return xsimd::sqrt(a); }
  static FRONTALIS_LAW Batch exp(const Batch& a) { return xsimd::exp(a); }
  static FRONTALIS_LAW Batch log(const Batch& a) { return xsimd::log(a); }
  static constexpr bool is_double = false;

  /// Finds a first guess from the exponent (error 3.4 %) and corrects it twice with cubic convergence, to within 2 ulp.
  static FRONTALIS_LAW Batch inverse_cube_root(const Batch& a)
  {
    using Integers = xsimd::batch<std::int32_t, Architecture>;
    const Batch bits = xsimd::to_float(xsimd::bitwise_cast<Integers>(a));
    const Batch guess = of(1419967116.0) - bits * of(1.0 / 3.0);
    Batch y = xsimd::bitwise_cast<Batch>(xsimd::to_int(guess));
    for (int i = 0; i < 2; ++i)
    {
      const Batch r = of(1) - a * y * y * y;
      y = y + y * r * (of(1.0 / 3.0) + r * of(2.0 / 9.0));
    }
    return y;
  }
};

/// A SIMD batch of doubles as the number type of a law, one voxel per lane.
template <class Architecture>
struct Number<xsimd::batch<double, Architecture>>
{
  using Batch = xsimd::batch<double, Architecture>;
  using Bool = typename Batch::batch_bool_type;

  static FRONTALIS_LAW Batch of(double value) { return Batch(value); }
  static FRONTALIS_LAW Batch select(const Bool& condition, const Batch& yes, const Batch& no)
  {
    return xsimd::select(condition, yes, no);
  }
  static FRONTALIS_LAW Batch max(const Batch& a, const Batch& b) { return xsimd::max(a, b); }
  static FRONTALIS_LAW Batch min(const Batch& a, const Batch& b) { return xsimd::min(a, b); }
  static FRONTALIS_LAW Batch sqrt(const Batch& a) { return xsimd::sqrt(a); }
  static FRONTALIS_LAW Batch exp(const Batch& a) { return xsimd::exp(a); }
  static FRONTALIS_LAW Batch log(const Batch& a) { return xsimd::log(a); }
  static constexpr bool is_double = true;
  static FRONTALIS_LAW Batch inverse_cube_root(const Batch& a) { return of(1) / xsimd::cbrt(a); }
};

}  // namespace physics
}  // namespace frontalis
