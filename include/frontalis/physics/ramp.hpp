#pragma once

#include "frontalis/physics/number.hpp"

namespace frontalis
{
namespace physics
{

/// Fraction of a load that acts at a time [s]: it grows linearly from 0 to 1 over the ramp [s]; 1 without a ramp.
FRONTALIS_LAW double ramped(double time, double ramp) { return ramp > 0 && time < ramp ? time / ramp : 1.0; }

}  // namespace physics
}  // namespace frontalis
