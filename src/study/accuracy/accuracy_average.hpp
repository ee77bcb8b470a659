#pragma once

#include "study/accuracy/accuracy_run.hpp"

#include <utility>
#include <vector>

namespace frontalis
{

/// Averages displacements of a skin over the neighbourhood at rest, so that errors are compared without those of single
/// folds.
class SkinAverage
{
public:
  /// For skins with the reference's rest positions. Weights are those of a Gaussian of this standard deviation [m],
  /// times the area.
  SkinAverage(const VariantMotion& reference, double deviation);

  /// The motion with averaged displacements; landmarks stay as they are.
  VariantMotion of(const VariantMotion& motion) const;
  /// Against the averaged reference, in the worst phase. Throws Error as skin_errors().
  SkinError error(const VariantMotion& motion) const;

private:
  std::vector<std::vector<std::pair<std::size_t, float>>> weights_;  // per vertex
  VariantMotion reference_;                                          // averaged
};

}  // namespace frontalis
