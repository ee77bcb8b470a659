#pragma once

#include "frontalis/model/contact.hpp"
#include "frontalis/physics/pushed_body.hpp"
#include "solver/contact/body_motion.hpp"

#include <vector>

namespace frontalis
{

/// State of a body at the start of a step. Of a body that is not pushed, only the times of the inherited members count.
struct BodyState : physics::PushedMotion<double>
{
  RigidTransform pose;
  double way;  ///< sum of the longest displacements of a bound node and of a body in each step so far [m]
};

/// Pose of a body that moves with its bone.
RigidTransform held_pose(const Contact& contact, const std::vector<RigidTransform>& bones);

/// Position that the body's centre has in that pose [m].
physics::Vec3<double> held_centre(const Contact& contact, const std::vector<RigidTransform>& bones);

/// The law of motion of a body that is pushed.
physics::PushedBody<double> pushed_body(const Contact& contact);

/// Kinetic energy of a body and energy of its spring [J]; 0 if it is not pushed.
double energy_of(const Contact& contact, const physics::PushedMotion<double>& motion);

/// Pose of a body that is pushed, which turns with its bone. `motion`: of the body at the same time as `bones`.
RigidTransform pushed_pose(const Contact& contact, const physics::PushedMotion<double>& motion,
                           const std::vector<RigidTransform>& bones);

/// The body at the end of a step; `dt` and `kick` stay 0. A body that is not pushed moves with its bone. `reaction`: of
/// the tissue at the start of the step.
BodyState moved_on(const Contact& contact, const BodyState& before, const Reaction& reaction,
                   const std::vector<RigidTransform>& bones);

/// The stiffness of contact with a pushed body counts 1 + s times, s = pushed_share, in the bound of the tissue's
/// frequency. A spring between a node and a body stores
///   k (a - b)^2 / 2 <= (1 + s) k a^2 / 2 + (1 + 1 / s) k b^2 / 2,
/// so that node and body are bounded separately, the body by longest_pushed_step().
constexpr double pushed_share = 0.1;
inline double counted(const Contact& contact) { return contact.mass > 0 ? 1 + pushed_share : 1; }

/// Longest stable step [s] of a body that is pushed. `stiffness`: of all points that may touch it [N/m].
double longest_pushed_step(const Contact& contact, double stiffness);

}  // namespace frontalis
