#pragma once

#include "frontalis/model/surface.hpp"

namespace frontalis
{

/// Whether all numbers are finite and the rotation is one (no mirror, no scaling), to within 1e-6.
bool is_rigid_motion(const RigidTransform& pose);

/// Rotation (as a rotation vector) and translation at a fraction of the way between two poses.
RigidTransform interpolate(const RigidTransform& from, const RigidTransform& to, double fraction);

/// The map that does `first`, then `then`.
RigidTransform composed(const RigidTransform& then, const RigidTransform& first);
RigidTransform inverse(const RigidTransform& pose);

/// Rotation by a rotation vector (axis times angle [rad]) about the origin, then a translation [m].
RigidTransform rigid_motion(const std::array<double, 3>& rotation, const std::array<double, 3>& translation);

/// Largest distance [m] between the places of a corner at two poses, of the box between the origin and `corner` [m].
double farthest_way(const RigidTransform& from, const RigidTransform& to, const std::array<double, 3>& corner);

/// Length [m] of the path that such a corner would go if it moved along interpolate() at all times as fast as the
/// fastest corner does at any time.
double fastest_way(const RigidTransform& from, const RigidTransform& to, const std::array<double, 3>& corner);

}  // namespace frontalis
