#pragma once

#include "study/accuracy/accuracy_run.hpp"

#include <utility>
#include <vector>

namespace frontalis
{

/// Displacements of a skin averaged over its neighbourhood at rest: what is left of errors when one looks away from
/// folds.
class SkinAverage
{
public:
  /// Of skins that rest as the reference's; weights are those of a Gaussian of so much [m], times the area.
  SkinAverage(const VariantMotion& reference, double deviation);

  /// Its phases with averaged displacements; landmarks stay.
  VariantMotion of(const VariantMotion& motion) const;
  /// Beside the averaged reference, in the worst phase. Throws Error as skin_errors().
  SkinError error(const VariantMotion& motion) const;

private:
  std::vector<std::vector<std::pair<std::size_t, float>>> weights_;  // of each vertex
  VariantMotion reference_;                                          // averaged
};

}  // namespace frontalis
