#pragma once

#include "bake/bake_monitor.hpp"

namespace frontalis
{

/// Warns of materials, muscles, layers and gravity that are so far from any tissue, bone or silicone that a unit is
/// probably missing or wrong: a number without a unit is in SI units, so that 'young: 34' is 34 Pa.
void check_magnitudes(const Scene& scene, const Model& model, BakeMonitor& monitor);

/// Warns of bones that expressions, action units or the demo turn although the scene gives no centre for them.
void check_bone_centres(const Scene& scene, BakeMonitor& monitor);

}  // namespace frontalis
