#pragma once

#include "frontalis/physics/number.hpp"

namespace frontalis
{
namespace physics
{

/// Node that glides on a plane normal . u = offset (normal of length 1): takes from its displacement and velocity what
/// leaves the plane (after Lapeer et al. 2019). Returns the normal velocity taken; times the mass it is the impulse of
/// the constraint in that step: its reaction m dp/dt^2, without the jumps of dp where the plane itself is renewed.
template <class T>
FRONTALIS_LAW T slide(const Vec3<T>& normal, const T& offset, Vec3<T>& u, Vec3<T>& v)
{
  const T error = dot(normal, u) - offset;
  const T speed = dot(normal, v);
  u = u - error * normal;
  v = v - speed * normal;
  return speed;
}

/// Coulomb friction in one step: the proportion of its tangential speed that a gliding node loses, from the normal
/// speed that the constraint took from it. 1: it sticks. The mass cancels.
template <class T>
FRONTALIS_LAW T friction_loss(const T& coefficient, const T& normal_speed, const T& tangential_speed)
{
  using N = Number<T>;
  const T allowed = coefficient * N::max(normal_speed, -normal_speed);
  return N::select(tangential_speed > allowed, allowed / N::max(tangential_speed, allowed), N::of(1));
}

}  // namespace physics
}  // namespace frontalis
