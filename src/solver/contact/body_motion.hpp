#pragma once

#include "frontalis/model/surface.hpp"
#include "frontalis/physics/number.hpp"
#include "frontalis/solver/reaction.hpp"

namespace frontalis
{

inline physics::Vec3<double> vector(const std::array<double, 3>& a) { return { a[0], a[1], a[2] }; }
void add_vector(std::array<double, 3>& sum, const physics::Vec3<double>& v);

/// Adds to `sum` the reaction to a force on the tissue [N] that acts at `arm` from the origin of the body's frame [m].
void add_reaction(Reaction& sum, const physics::Vec3<double>& arm, const physics::Vec3<double>& force);

/// Motion of a body's frame in a step; the rotation is small enough for a rotation vector.
struct BodyMotion
{
  physics::Vec3<double> shift, turn;  ///< shift of the origin [m]; rotation vector [rad]
};
BodyMotion motion_between(const RigidTransform& from, const RigidTransform& to);

/// Work of a moving body against the mean of two reactions [J].
double work_between(const Reaction& before, const Reaction& after, const BodyMotion& motion);

/// Largest distance [m] that the motion between two poses would move any point of the tissue. far_corner: the corner of
/// the grid opposite to its origin [m].
double longest_way(const RigidTransform& from, const RigidTransform& to, const std::array<double, 3>& far_corner);

}  // namespace frontalis
