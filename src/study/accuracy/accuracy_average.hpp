#pragma once

#include "study/accuracy/accuracy_run.hpp"

#include <utility>
#include <vector>

namespace frontalis
{

/// Averages the displacements of a skin over the neighbourhood of each vertex at rest, so that single folds do not
/// dominate the errors.
class SkinAverage
{
public:
  /// All motions must have the reference's rest positions. The weights are a Gaussian of this standard deviation [m]
  /// times the area.
  SkinAverage(const VariantMotion& reference, double deviation);

  /// The motion with averaged displacements; landmarks stay as they are.
  VariantMotion of(const VariantMotion& motion) const;
  /// Error against the averaged reference in the worst phase. Throws Error if skin_errors() does.
  SkinError error(const VariantMotion& motion) const;

private:
  std::vector<std::vector<std::pair<std::size_t, float>>> weights_;  // per vertex
  VariantMotion reference_;                                          // averaged
};

}  // namespace frontalis
