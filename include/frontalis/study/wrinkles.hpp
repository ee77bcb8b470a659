#pragma once

#include "frontalis/solver/solver_state.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace frontalis
{

struct WrinkleSettings
{
  /// Standard deviation [m] of the window in which a quadratic surface is fitted to the skin. This surface represents
  /// the skin without folds. It follows folds a little: its own waves have 0.4 % of the height of folds with a
  /// wavelength of 16 mm, 4 % at 20 mm and a third at 30 mm.
  double window = 10e-3;
  double least_depth = 0.15e-3;    ///< smallest depth of a furrow below the ridges on both sides of it [m]
  double least_length = 10e-3;     ///< shorter furrows are left out [m]
  double section_distance = 2e-3;  ///< distance between two sections across the furrows [m]
  /// Only furrows in this box at rest count; it is in the skin's frame [m].
  std::array<double, 3> lower{ { -1e9, -1e9, -1e9 } }, upper{ { 1e9, 1e9, 1e9 } };

  bool contains(const std::array<float, 3>& at_rest) const
  {
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (at_rest[axis] < lower[axis] || at_rest[axis] > upper[axis])
        return false;
    return true;
  }
};

/// One furrow, a line in the skin.
struct Furrow
{
  double depth = 0;   ///< height of the ridges on both sides above the bottom, mean over the furrow's sections [m]
  double length = 0;  ///< [m]
  std::array<double, 3> middle{};  ///< mean position of its bottom [m]
};

struct Wrinkles
{
  std::vector<Furrow> furrows;        ///< longest first
  std::array<double, 3> direction{};  ///< unit vector along the furrows; 0 if there are none
  double depth = 0, deepest = 0;      ///< mean over all sections, and the largest [m]; 0 if there are none
  /// median distance of neighbouring furrows along the skin [m]; 0 if no two are beside each other
  double spacing = 0;
  double count = 0;  ///< mean number of furrows in a section that has at least one
};

using SkinTriangles = std::vector<std::array<std::int32_t, 3>>;

/// Height of each vertex above the skin without folds, along the normal of that skin [m]. The skin without folds is the
/// quadratic surface that is fitted, by least squares with Gaussian weights of area, to the skin around the vertex.
std::vector<double> fold_heights(const SkinState& skin, const SkinTriangles& triangles, double window);

/// Measures the furrows that a skin has now and did not have at rest, from present heights less those at rest. The
/// direction of the furrows is that in which heights change least. Sections across this direction are searched for
/// furrows, which are joined to lines. Sections follow the skin without folds, so that a fold may overhang.
class WrinkleMeter
{
public:
  /// Called now and then with the completed fraction; an exception that it throws ends the measurement.
  using Progress = std::function<void(double)>;

  /// Finds the heights of the skin at rest, once for all measurements.
  WrinkleMeter(SkinState rest, SkinTriangles triangles, const WrinkleSettings& settings = {},
               const Progress& progress = {});

  Wrinkles measure(const SkinState& now, const Progress& progress = {}) const;

private:
  SkinState rest_;
  SkinTriangles triangles_, near_;  ///< all, and those near the box of the settings
  WrinkleSettings settings_;
  std::vector<double> heights_;  ///< at rest, of the corners of near_ [m]
};

}  // namespace frontalis
