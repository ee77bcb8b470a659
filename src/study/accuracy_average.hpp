#pragma once

#include "accuracy_run.hpp"

#include <utility>
#include <vector>

namespace frontalis
{

/// Displacements of a skin averaged over its neighbourhood at rest: what is left of errors when one looks away from
/// folds.
class SkinAverage
{
public:
  /// Of skins that rest as this one; weights are those of a Gaussian of so much [m], times the area.
  SkinAverage(const VariantMotion& motion, double deviation);

  /// Its phases with averaged displacements; landmarks stay.
  VariantMotion of(const VariantMotion& motion) const;

private:
  std::vector<std::vector<std::pair<std::size_t, float>>> weights_;  // of each vertex
};

}  // namespace frontalis
