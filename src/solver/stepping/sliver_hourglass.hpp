#pragma once

#include "frontalis/model/model.hpp"

#include <algorithm>

namespace frontalis
{

/// A voxel with at most this much tissue has its least hourglass stiffness in full, one with twice as much has none.
constexpr double sliver_fill = 0.1;

/// Least hourglass stiffness [N/m] of slivers: three times that of a full voxel of the softest material that voxels
/// contain. With a third of it the hard case slivers is erratic: corners are thrown by 3.5 to 5.5 edges, depending on
/// the time step, instead of 3.1 to 3.3.
double least_hourglass(const Model& model);

/// Least hourglass stiffness [N/m] of a nearly empty voxel, a sliver: `least` (least_hourglass()), but at most half of
/// what the sliver's time step allows.
///
/// A corner of a sliver has next to no mass and often belongs to no other voxel. It hardly changes the voxel's mean
/// gradient, and hourglass control in proportion to the tissue leaves it nearly free: a wave that runs into the corner
/// throws it at ten times the speed of the tissue around it, over many voxels. The least stiffness ties the corner to
/// the linear motion of the other corners and has no force on a linear motion, like the ghost penalty of cut-cell
/// methods (Burman 2010). It does not shorten the time step, because hourglass modes are orthogonal to stress modes: 8
/// times it stays below half of their bound, `stress_modes` [N/m] (physics::voxel_stiffness).
inline double sliver_hourglass(double fill, double least, double stress_modes)
{
  return std::min(std::clamp(2 - fill / sliver_fill, 0.0, 1.0) * least, 0.5 * stress_modes / 8);
}

}  // namespace frontalis
