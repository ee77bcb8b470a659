#pragma once

#include "bake/fibres/grid_field.hpp"

#include <array>
#include <vector>

namespace frontalis
{

/// Maps a value of a field to the mean distance [m] of the places that have it from those with the field's least value.
class DistanceTable
{
public:
  /// `periodic`: the field counts revolutions around a ring, of which the fraction is used.
  DistanceTable(const MuscleGrid& grid, const CornerField& field, bool periodic);
  double length() const { return distances_.back(); }
  double operator()(double value) const;

private:
  std::vector<double> values_, distances_;
};

/// Stretches one of two coordinates so that it runs from 0 to 1 at every value of the other. 0 and 1 are its smoothed
/// limits on the muscle's surface. Lines along which the other coordinate is constant keep their shape.
class Stretch
{
public:
  /// `samples`: both coordinates at the grid's samples. `stretched`: the index of the coordinate to stretch. `closed`:
  /// the other coordinate runs around a ring. If the other coordinate is closer than `ends` to 0 or 1, the limits at
  /// that distance are used.
  Stretch(const MuscleGrid& grid, const std::vector<std::array<double, 2>>& samples, std::size_t stretched, bool closed,
          double ends);
  void apply(std::array<double, 2>& coordinates) const;

private:
  static constexpr std::size_t bins = 32;

  static std::size_t bin(double value);
  std::size_t before(std::size_t b) const { return b > 0 ? b - 1 : (closed_ ? bins - 1 : 0); }
  std::size_t after(std::size_t b) const { return b + 1 < bins ? b + 1 : (closed_ ? 0 : b); }
  /// Averages neighbouring bins. `given` is 0 for a bin that has no limits yet.
  void smooth(std::array<double, bins>& given);

  std::size_t stretched_;
  bool closed_;
  std::array<double, bins> low_{}, high_{};
};

}  // namespace frontalis
