#pragma once

#include "frontalis/model/surface.hpp"
#include "frontalis/physics/number.hpp"

namespace frontalis
{

/// Arrays, in which the public interface has points and vectors, as vectors to compute with, and back.
template <class Number>
physics::Vec3<double> vector_of(const std::array<Number, 3>& a)
{
  return { static_cast<double>(a[0]), static_cast<double>(a[1]), static_cast<double>(a[2]) };
}
inline std::array<double, 3> array_of(const physics::Vec3<double>& v) { return { { v.x, v.y, v.z } }; }

/// Whether all numbers are finite and the rotation is proper (no reflection, no scaling), to within 1e-6.
bool is_rigid_motion(const RigidTransform& pose);

/// The pose at a fraction (0..1) of the screw motion between two poses: a turn about one axis and a shift along it.
RigidTransform interpolate(const RigidTransform& from, const RigidTransform& to, double fraction);

/// The map that applies `first`, then `then`.
RigidTransform composed(const RigidTransform& then, const RigidTransform& first);
RigidTransform inverse(const RigidTransform& pose);

/// Rotation by a rotation vector (axis times angle [rad]) about the origin, then a translation [m].
RigidTransform rigid_motion(const std::array<double, 3>& rotation, const std::array<double, 3>& translation);

/// Largest displacement [m] of a corner of the box between the origin and `corner` [m] from one pose to another.
double farthest_way(const RigidTransform& from, const RigidTransform& to, const std::array<double, 3>& corner);

/// Bound [m] of the length of the path that a corner of the box between the origin and `corner` [m] takes along
/// interpolate(): the highest speed times the duration.
double fastest_way(const RigidTransform& from, const RigidTransform& to, const std::array<double, 3>& corner);

}  // namespace frontalis
