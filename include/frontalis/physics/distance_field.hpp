#pragma once

#include "frontalis/physics/field_spline.hpp"

#include <cmath>
#include <cstdint>

namespace frontalis
{
namespace physics
{

/// Signed distance from a surface [m], positive on the side of its outward normals, in the surface's frame. The surface
/// is a sphere, or its distance is sampled on a lattice. Samples are the coefficients of a quadratic B-spline (de Boor,
/// A Practical Guide to Splines, 1978), which is smooth: its gradient has no kinks, and it rounds the surface's edges
/// within about one spacing. Arrays are plain pointers, so that the same code runs on host and GPU.
///
/// A cell is the cube around one sample. Only cells that nodes may reach are stored, in bricks of 8 x 8 x 8. A brick
/// repeats one layer of its neighbours' samples, so that it has the 3 x 3 x 3 samples around each of its cells.
struct DistanceField
{
  static constexpr std::int32_t brick_edge = 8;              ///< [cells]
  static constexpr std::int32_t brick_row = brick_edge + 2;  ///< [samples]
  static constexpr std::int32_t brick_size = brick_row * brick_row * brick_row;

  double origin[3] = { 0, 0, 0 };        ///< position of sample (0,0,0), or centre of the sphere [m]
  double spacing = 1;                    ///< distance between neighbouring samples [m]
  double radius = 0;                     ///< radius of the sphere [m]; 0: the field is sampled
  std::int32_t bricks[3] = { 0, 0, 0 };  ///< number of bricks in the table along x, y, z
  /// index of each brick's samples, x fastest; negative: the brick has no samples
  const std::int32_t* table = nullptr;
  const float* samples = nullptr;  ///< brick_size per brick, x fastest; the first belongs to cell (-1,-1,-1) [m]

  /// The first of the 3 x 3 x 3 samples around a cell; null if none are stored.
  FRONTALIS_LAW const float* around(const std::int32_t (&cell)[3]) const
  {
    std::int32_t brick = 0, first = 0;
    for (int axis = 2; axis >= 0; --axis)
    {
      const std::int32_t b = cell[axis] >> 3;
      if (b < 0 || b >= bricks[axis])
        return nullptr;
      brick = brick * bricks[axis] + b;
      first = first * brick_row + (cell[axis] & 7);
    }
    brick = table[brick];
    return brick < 0 ? nullptr : samples + static_cast<std::int64_t>(brick) * brick_size + first;
  }
};

/// A point, stored as a cell of a field and the offset from the sample at the cell's centre [m]. While a node moves, it
/// keeps the cell of its rest position, so that the offset may become longer than a cell. A float resolves the offset
/// to nanometres.
template <class T>
struct FieldPoint
{
  std::int32_t cell[3];
  Vec3<T> offset;
};

/// Converts the point p [m], in the surface's frame, to a cell and an offset. The only cell of a sphere is (0,0,0), at
/// its centre.
FRONTALIS_LAW FieldPoint<double> field_point(const DistanceField& field, const Vec3<double>& p)
{
  FieldPoint<double> point{ { 0, 0, 0 }, p - Vec3<double>{ field.origin[0], field.origin[1], field.origin[2] } };
  if (field.radius > 0)
    return point;
  double* const offset[3] = { &point.offset.x, &point.offset.y, &point.offset.z };
  for (int axis = 0; axis < 3; ++axis)
  {
    const double whole = std::floor(*offset[axis] / field.spacing + 0.5);
    // `sound` is false if the coordinate is NaN or the motion has diverged.
    const bool sound = whole > -1e9 && whole < 1e9;
    point.cell[axis] = sound ? static_cast<std::int32_t>(whole) : -1000000000;
    *offset[axis] = sound ? *offset[axis] - whole * field.spacing : 0;
  }
  return point;
}

/// The n-th of the samples around a cell, x fastest; `first` is what around() returned.
FRONTALIS_LAW float gather_one(const float* first, int n)
{
  return first[(n / 9 * DistanceField::brick_row + n / 3 % 3) * DistanceField::brick_row + n % 3];
}
/// Loads the samples around a cell; `first` is what around() returned.
FRONTALIS_LAW FieldSamples gather(const float* first)
{
  FieldSamples samples;
  FRONTALIS_UNROLL
  for (int n = 0; n < 27; ++n)
    samples.value[n] = gather_one(first, n);
  return samples;
}

/// Moves whole cells from `offset` into `cell`. Returns the remaining offset [cells], from -0.5 to 0.5 per axis.
template <class T>
FRONTALIS_LAW Vec3<T> enter_cell(const T& inverse_spacing, const Vec3<T>& offset, std::int32_t (&cell)[3])
{
  T x[3] = { inverse_spacing * offset.x, inverse_spacing * offset.y, inverse_spacing * offset.z };
  for (int axis = 0; axis < 3; ++axis)
  {
    const T whole = std::floor(x[axis] + T(0.5));
    cell[axis] += static_cast<std::int32_t>(whole);
    x[axis] -= whole;
  }
  return { x[0], x[1], x[2] };
}

/// Finds the field at a point. Returns false, and leaves `value` unchanged, if no samples are stored there.
/// inverse_spacing: 1 / field.spacing.
template <class T>
FRONTALIS_LAW bool sample(const DistanceField& field, const T& inverse_spacing, FieldPoint<T> point,
                          FieldValue<T>& value)
{
  if (field.radius > 0)
  {
    value = sphere_value(norm(point.offset) - static_cast<T>(field.radius), point.offset, { T(0), T(0), T(0) });
    return true;
  }
  const Vec3<T> place = enter_cell(inverse_spacing, point.offset, point.cell);
  const float* const first = field.around(point.cell);
  if (first == nullptr)
    return false;
  value = spline(gather(first), inverse_spacing, place);
  return true;
}
template <class T>
FRONTALIS_LAW bool sample(const DistanceField& field, const FieldPoint<T>& point, FieldValue<T>& value)
{
  return sample(field, static_cast<T>(1 / field.spacing), point, value);
}

/// Lower bound of the distance [m] from the surface to a point that has no samples around it. p: the point in the
/// surface's frame [m]; reach: distance from the surface up to which samples are stored [m].
FRONTALIS_LAW double distance_without_samples(const DistanceField& field, double reach, const Vec3<double>& p)
{
  const double at[3] = { p.x, p.y, p.z };
  double squared = 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double begin = field.origin[axis] - 0.5 * field.spacing;
    const double end = begin + field.bricks[axis] * DistanceField::brick_edge * field.spacing;
    const double outside = at[axis] < begin ? begin - at[axis] : at[axis] > end ? at[axis] - end : 0;
    squared += outside * outside;
  }
  return Number<double>::max(0.5 * reach, Number<double>::sqrt(squared));
}

}  // namespace physics
}  // namespace frontalis
