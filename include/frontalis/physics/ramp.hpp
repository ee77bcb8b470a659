#pragma once

#include "frontalis/physics/number.hpp"

namespace frontalis
{
namespace physics
{

/// Share of a load that acts at a time: linear over its ramp, then whole; without one at once [s].
FRONTALIS_LAW double ramped(double time, double ramp) { return ramp > 0 && time < ramp ? time / ramp : 1.0; }

}  // namespace physics
}  // namespace frontalis
