#pragma once

#include "frontalis/physics/distance_field.hpp"
#include "solver/cpu/record_lanes.hpp"

namespace frontalis
{

/// Evaluates distance fields at points, one point per lane.
template <class Architecture>
struct FieldLanes
{
  using Lanes = RecordLanes<Architecture>;
  using Batch = typename Lanes::Batch;
  using Vector = typename Lanes::Vector;
  static constexpr int count = Lanes::count;

  /// The samples of a batch of points, in the form that physics::spline() reads.
  struct Samples
  {
    Batch value[27];
  };
  /// first: per lane, DistanceField::around() of the point's cell.
  static FRONTALIS_LAW Samples samples(const float* const* first)
  {
    constexpr int row_size = physics::DistanceField::brick_row;
    Samples samples;
    const auto keep = [&](int row, const Vector& of)
    {
      samples.value[3 * row] = of.x;
      samples.value[3 * row + 1] = of.y;
      samples.value[3 * row + 2] = of.z;
    };
    for (int row = 0; row < 8; ++row)
      keep(row, Lanes::gather_vectors([&](int l) { return first[l] + (row / 3 * row_size + row % 3) * row_size; }));
    keep(8, Lanes::template gather_vectors<1>([&](int l) { return first[l] + (2 * row_size + 2) * row_size; }));
    return samples;
  }
};

}  // namespace frontalis
