#pragma once

#include "frontalis/model/restriction.hpp"

namespace frontalis
{

/// Limits the difference of neighbouring samples to their spacing, which no true distance exceeds. Where the nearest
/// point of a surface with a rim jumps from one place to another, sampled values may jump by millimetres; the jump
/// becomes a slope. Other samples keep their values.
void limit_slope(SampledField& field);

}  // namespace frontalis
