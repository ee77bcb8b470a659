#pragma once

#include "frontalis/physics/field_spline.hpp"
#include "frontalis/physics/sliding.hpp"

#include <cstdint>

namespace frontalis
{
namespace physics
{

/// Contact acts as a stiffness: a point at depth g inside a body is pushed out by the pressure
///   p = contact_stiffness E g / h,
/// where E is Young's modulus of the mixture in the point's voxel and h the shortest voxel edge. A pressure of 5 % of E
/// thus pushes the point in by 1.4 % of a voxel, for every Poisson's ratio. (With a multiple of the longitudinal
/// modulus in place of E, the depth would be 13 times as large at a ratio of 0.3 as at 0.49.) Where nodes of nearly
/// incompressible tissue touch a body, the highest squared frequency of the model grows by 3.5 %, so that steps are
/// 1.7 % shorter.
constexpr double contact_stiffness = 3.5;

/// Stiffness along the surface of a point that sticks, divided by the stiffness along the normal.
constexpr double sticking_stiffness = 0.5;

/// Largest norm of the gradient of a sampled distance field. The gradient of an exact distance has length 1; each
/// component of a spline's gradient is a mean of slopes of at most 1, so that its norm is at most sqrt(3).
constexpr double steepest_field = 1.7320508;

/// Friction follows the normal force with a delay. After a point has left its body, the delayed force is set to zero
/// once it is less than the contact force at this depth [m].
constexpr double forgotten_depth = 1e-9;

/// Whether a point touches a body.
enum class Touching : std::uint8_t
{
  no,
  yes,
  let_go,  ///< it has left the body in this step
  lost     ///< deeper in the body than its field has samples
};

/// State of friction at a point, kept from step to step.
template <class T>
struct Grip
{
  Vec3<T> anchor;  ///< where the force along the surface would be zero, in the body's frame [m]
  T normal;        ///< normal force, delayed by friction_response() [N]
  T along;         ///< force along the surface [N]
};

/// Contact of one point with a body.
template <class T>
struct Touch
{
  Vec3<T> force;  ///< force on the point, in the body's frame [N]
  Grip<T> grip;
  T stored;  ///< energy in the stiffness of contact [J]
  T lost;    ///< energy dissipated by friction in this step [J]
};

/// Force of a frictionless body on a point inside it, in the body's frame [N]: minus the gradient of
/// 1/2 stiffness value^2, so that such a body adds no energy. `stiffness`: of the point [N/m].
template <class T>
FRONTALIS_LAW Vec3<T> push(const FieldValue<T>& field, const T& stiffness)
{
  return (stiffness * -field.value) * field.gradient;
}

/// Contact and Coulomb friction of a point inside a body (field.value < 0). `x`: position in the body's frame [m];
/// `grip`: the grip that was returned in the previous step or, when contact begins, an anchor at x with the forces that
/// let_go() left; `stiffness`: of the point [N/m]; `friction`: Coulomb's coefficient; `response`: friction_response().
/// Friction needs this delay, because elastic bodies flutter where they slide if friction follows the normal force at
/// once.
///
/// The normal force is that of push(). Friction is the tangential stiffness times the displacement from the anchor,
/// returned to Coulomb's cone (Simo & Laursen, An augmented Lagrangian treatment of contact problems involving
/// friction, Computers & Structures 42(1), 1992). The anchor follows the point along the normal, because a change of
/// depth would become a tangential displacement, and create energy, as the normal turns.
template <class T>
FRONTALIS_LAW Touch<T> touch(const FieldValue<T>& field, const Vec3<T>& x, const Grip<T>& grip, const T& stiffness,
                             const T& friction, const T& response)
{
  using N = Number<T>;
  const T depth = -field.value, slope = norm(field.gradient);
  const T pressed = stiffness * depth;
  const T normal_force = grip.normal + response * (pressed * slope - grip.normal);
  const Vec3<T> normal = (T(1) / N::max(slope, N::of(1e-9))) * field.gradient;
  const Vec3<T> way = x - grip.anchor;
  const Vec3<T> sunk = dot(normal, way) * normal, along = way - sunk;
  const T along_stiffness = N::of(sticking_stiffness) * stiffness;
  const T length = norm(along), trial = along_stiffness * length;
  const T allowed = mutation::no_friction ? N::of(0) : friction * normal_force;
  const auto slips = trial > allowed;
  const T kept = N::select(slips, allowed / N::max(trial, N::of(1e-30)), N::of(1));
  const Vec3<T> left = kept * along;
  // A sum of displacements, so that rounding does not move the anchor of a point that rests.
  const Vec3<T> anchor = grip.anchor + (sunk + (along - left));
  return { push(field, stiffness) - along_stiffness * left,
           { anchor, normal_force, kept * trial },
           N::of(0.5) * (pressed * depth + along_stiffness * dot(left, left)),
           N::of(0.5) * (grip.along + kept * trial) * (length - kept * length) };
}

/// Updates the grip of a point that is outside the body: friction drops to zero, and the delayed normal force decays.
/// Returns the stored energy that is lost with friction [J].
template <class T>
FRONTALIS_LAW T let_go(Grip<T>& grip, const T& stiffness, const T& response)
{
  const T lost = Number<T>::of(0.5 / sticking_stiffness) * grip.along * grip.along / stiffness;
  grip.along = T(0);
  grip.normal = grip.normal - response * grip.normal;
  return lost;
}

}  // namespace physics
}  // namespace frontalis
