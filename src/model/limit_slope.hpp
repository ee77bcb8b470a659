#pragma once

#include "frontalis/model/restriction.hpp"

namespace frontalis
{

/// Makes values of neighbouring samples differ by at most their spacing, as those of any distance do. Where the nearest
/// point of a surface with a rim jumps from one place to another, the value may jump by millimetres; this jump becomes
/// a slope. Other samples keep their values.
void limit_slope(SampledField& field);

}  // namespace frontalis
