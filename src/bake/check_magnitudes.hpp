#pragma once

#include "bake/bake_monitor.hpp"

namespace frontalis
{

/// Warns of materials, muscles and gravity that are so far from any tissue, bone or silicone that a unit is probably
/// missing or wrong: a number without a unit is in SI units, so that 'young: 34' is 34 Pa.
void check_magnitudes(const Scene& scene, const Model& model, BakeMonitor& monitor);

}  // namespace frontalis
