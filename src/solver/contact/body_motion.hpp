#pragma once

#include "frontalis/solver/reaction.hpp"
#include "frontalis/solver/rigid_motion.hpp"

namespace frontalis
{

void add_vector(std::array<double, 3>& sum, const physics::Vec3<double>& v);

/// Adds the opposite of a force on the tissue [N] to `sum`. `arm`: from the origin of the body's frame to the force's
/// point [m].
void add_reaction(Reaction& sum, const physics::Vec3<double>& arm, const physics::Vec3<double>& force);

/// Motion of a body's frame in a step. The rotation is small, so that a rotation vector describes it.
struct BodyMotion
{
  physics::Vec3<double> shift, turn;  ///< shift of the origin [m]; rotation vector [rad]
};
BodyMotion motion_between(const RigidTransform& from, const RigidTransform& to);

/// Work of a moving body against the mean of two reactions [J], those before and after the motion.
double work_between(const Reaction& before, const Reaction& after, const BodyMotion& motion);

/// Largest distance [m] by which the motion between two poses would move any point of the tissue. far_corner: the
/// corner of the grid opposite to its origin [m].
double longest_way(const RigidTransform& from, const RigidTransform& to, const std::array<double, 3>& far_corner);

}  // namespace frontalis
