#pragma once

#include "frontalis/model/contact.hpp"
#include "solver/contact/body_motion.hpp"

#include <vector>

namespace frontalis
{

/// A body at the start of a step.
struct BodyState
{
  RigidTransform pose;
  double way;   ///< bound of how far any point and body have approached each other so far [m]
  double dt;    ///< length of the step [s]; 0: there was none
  double kick;  ///< time over which forces change velocities in the step [s]
  // of a body that is pushed
  physics::Vec3<double> held_at;   ///< place of its centre if it kept its pose relative to its bone [m]
  physics::Vec3<double> velocity;  ///< half a step before [m/s]
};

/// Where a bone holds a body.
RigidTransform held_pose(const Contact& contact, const std::vector<RigidTransform>& bones);

/// The body at the end of a step; `dt` and `kick` stay 0. A body that is not pushed moves with its bone. A pushed body
/// turns with its bone, and its centre moves by central differences, as nodes do: the tissue's impulse on it in a step
/// is exactly the opposite of its own on the tissue. Half of the damping acts on the new velocity, so that it sets no
/// limit to the step. `reaction`: of the tissue at the start of the step.
BodyState moved_on(const Contact& contact, const BodyState& before, const Reaction& reaction,
                   const std::vector<RigidTransform>& bones);

/// Factor 1 + s, s = pushed_share, on the stiffness of contact with a pushed body in the bound of the tissue's
/// frequency. A spring between a node and a body stores
///   k (a - b)^2 / 2 <= (1 + s) k a^2 / 2 + (1 + 1 / s) k b^2 / 2,
/// so that node and body are bounded separately, the body by longest_pushed_step().
constexpr double pushed_share = 0.1;
inline double counted(const Contact& contact) { return contact.mass > 0 ? 1 + pushed_share : 1; }

/// Longest stable step [s] of a body that is pushed. `stiffness`: of all points that may touch it [N/m].
double longest_pushed_step(const Contact& contact, double stiffness);

}  // namespace frontalis
