#pragma once

#include "frontalis/physics/mutation.hpp"
#include "frontalis/physics/number.hpp"

namespace frontalis
{
namespace physics
{

/// A sliding node that is off its plane goes back by half of the error per step, but for errors above twice this [m] by
/// all beyond this. The error comes suddenly, where the tangent plane of a node is renewed. Corrected within one step
/// it would add half the stiffness of the tissue times the error squared to the energy, and set the tissue vibrating.
constexpr double error_left = 4.5e-6;

/// Node that slides on a plane normal . u = offset (normal of length 1): removes the velocity along the normal (after
/// Lapeer et al. 2019) and most of the distance from the plane. Returns the normal velocity removed. Times the mass of
/// the node it is the impulse of the constraint in this step, without the jumps where the plane itself is renewed.
template <class T>
FRONTALIS_LAW T slide(const Vec3<T>& normal, const T& offset, Vec3<T>& u, Vec3<T>& v)
{
  using N = Number<T>;
  const T error = dot(normal, u) - offset;
  const T speed = dot(normal, v);
  const T left = N::max(N::min(N::of(0.5) * error, N::of(error_left)), N::of(-error_left));
  u = u - (error - left) * normal;
  v = v - speed * normal;
  return speed;
}

/// Velocity of a node whose tangent plane on a smooth surface is replaced by the next: it is turned with the normal, so
/// that the node keeps its speed. A projection would brake it. Where the normals differ by more than 0.3 rad the
/// surface has an edge, and nothing is turned.
template <class T>
FRONTALIS_LAW Vec3<T> turned_with_normal(const Vec3<T>& from, const Vec3<T>& to, const Vec3<T>& v)
{
  const T cosine = dot(from, to);
  if (!(cosine > Number<T>::of(0.955)))
    return v;
  const Vec3<T> sum = from + to;
  return v - (dot(sum, v) / (cosine + Number<T>::of(1))) * sum + (Number<T>::of(2) * dot(from, v)) * to;
}

/// Coulomb friction in one step: the fraction of its tangential speed that a sliding node loses, from the normal speed
/// that the constraint removed. 1: it sticks. The mass cancels.
template <class T>
FRONTALIS_LAW T friction_loss(const T& coefficient, const T& normal_speed, const T& tangential_speed)
{
  using N = Number<T>;
  if (mutation::no_friction)
    return N::of(0);
  const T allowed = coefficient * N::max(normal_speed, -normal_speed);
  return N::select(tangential_speed > allowed, allowed / N::max(tangential_speed, allowed), N::of(1));
}

/// Friction follows the reaction of the surface with a delay of 1 ms: the fraction of a change of the reaction that it
/// takes up in a step dt [s]. With friction that follows at once, sliding of an elastic body is ill-posed: friction
/// would feed the body's vibrations. This is Prakash & Clifton's law in its simplest form (Cochard & Rice 2000).
template <class T>
FRONTALIS_LAW T friction_response(const T& dt)
{
  return dt / (dt + Number<T>::of(1e-3));
}

}  // namespace physics
}  // namespace frontalis
