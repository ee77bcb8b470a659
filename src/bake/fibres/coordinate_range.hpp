#pragma once

#include "bake/fibres/grid_field.hpp"

#include <array>
#include <vector>

namespace frontalis
{

/// From a field's value to the mean way [m] on which the field reaches it from its least one.
class WayTable
{
public:
  /// `turns`: the field is one of turns around a ring, and counts modulo 1.
  WayTable(const MuscleGrid& grid, const CornerField& field, bool turns);
  double length() const { return ways_.back(); }
  double operator()(double value) const;

private:
  std::vector<double> values_, ways_;
};

/// Stretches one of two coordinates (0 or 1) so that it runs from 0 to 1 at every value of the other: by the limits of
/// the muscle's surface, smoothed. Lines on which the other is constant stay what they are.
class Stretch
{
public:
  /// `closed`: the other coordinate is one around a ring. Within `ends` of its 0 and 1 the limits are taken from
  /// further in. Samples as those of the grid.
  Stretch(const MuscleGrid& grid, const std::vector<std::array<double, 2>>& samples, std::size_t stretched, bool closed,
          double ends);
  void apply(std::array<double, 2>& coordinates) const;

private:
  static constexpr std::size_t bins = 32;

  static std::size_t bin(double value);
  std::size_t before(std::size_t b) const { return b > 0 ? b - 1 : (closed_ ? bins - 1 : 0); }
  std::size_t after(std::size_t b) const { return b + 1 < bins ? b + 1 : (closed_ ? 0 : b); }
  /// Averages neighbouring bins; `given`: 0 where a bin has no limits yet.
  void smooth(std::array<double, bins>& given);

  std::size_t stretched_;
  bool closed_;
  std::array<double, bins> low_{}, high_{};
};

}  // namespace frontalis
