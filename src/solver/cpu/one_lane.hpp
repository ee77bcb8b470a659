#pragma once

#include "frontalis/physics/number.hpp"

#include <cstddef>
#include <cstdint>

namespace frontalis
{

/// Scalar counterpart of RecordLanes, for a kernel without SIMD.
template <class Number>
struct OneLane
{
  using Real = Number;
  using Batch = Number;
  static constexpr int count = 1;

  static FRONTALIS_LAW Number load(const Number* p) { return *p; }
  static FRONTALIS_LAW Number gather(const Number* p, const std::int32_t* index) { return p[*index]; }
  static FRONTALIS_LAW void store(Number x, Number* p) { *p = x; }
  static FRONTALIS_LAW bool any_positive(Number x) { return x > 0; }

  static FRONTALIS_LAW std::uint32_t positive(Number x) { return x > 0 ? 1 : 0; }

  // See RecordLanes::gather_two().
  static FRONTALIS_LAW void gather_two(const Number* p, const std::int32_t* index, Number& first, Number& second)
  {
    first = p[*index];
    second = p[*index + 1];
  }
  static FRONTALIS_LAW physics::Vec3<Number> gather_records(const Number* p, std::ptrdiff_t stride,
                                                            const std::int32_t* index)
  {
    const Number* const record = p + stride * *index;
    return { record[0], record[1], record[2] };
  }
  static FRONTALIS_LAW void store_records(const physics::Vec3<Number>& v, Number* p)
  {
    p[0] = v.x;
    p[1] = v.y;
    p[2] = v.z;
    p[3] = 0;
  }
  static constexpr int record(int) { return 0; }
  static FRONTALIS_LAW void add_record(const Number* from, Number* to)
  {
    for (int axis = 0; axis < 3; ++axis)
      to[axis] += from[axis];
  }
  static FRONTALIS_LAW void copy_record(const Number* from, Number* to)
  {
    for (int axis = 0; axis < 4; ++axis)
      to[axis] = from[axis];
  }
};

}  // namespace frontalis
