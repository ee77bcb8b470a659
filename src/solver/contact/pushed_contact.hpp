#pragma once

#include "frontalis/model/contact.hpp"
#include "solver/contact/body_motion.hpp"

#include <vector>

namespace frontalis
{

/// State of a body at the start of a step.
struct BodyState
{
  RigidTransform pose;
  double way;   ///< upper bound of the distance by which any point and the body have approached each other so far [m]
  double dt;    ///< length of the step [s]; 0: no step has been made
  double kick;  ///< time over which forces change velocities in the step [s]
  // Members for a body that is pushed:
  physics::Vec3<double> held_at;   ///< position that its centre would have if it kept its pose relative to its bone [m]
  physics::Vec3<double> velocity;  ///< velocity half a step earlier [m/s]
};

/// Pose of a body that moves with its bone.
RigidTransform held_pose(const Contact& contact, const std::vector<RigidTransform>& bones);

/// The body at the end of a step; `dt` and `kick` stay 0. A body that is not pushed moves with its bone. A pushed body
/// turns with its bone, and its centre moves by central differences, as nodes do, so that the impulses of body and
/// tissue on each other are exact opposites. Half of the damping acts on the new velocity, so that damping does not
/// limit the time step. `reaction`: of the tissue at the start of the step.
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
