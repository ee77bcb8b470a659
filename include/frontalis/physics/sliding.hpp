#pragma once

#include "frontalis/physics/mutation.hpp"
#include "frontalis/physics/number.hpp"

namespace frontalis
{
namespace physics
{

/// Half of a gliding node's error, up to this [m], is left for the next step. Errors come all at once where a plane is
/// renewed; put back all at once too, they were blows that set the tissue vibrating, each with half its stiffness times
/// the error squared: a shell that spins on a ball gained 43 % in 40 ms, with planes that erred by
/// up to twice this. In halves it lost 13 %.
constexpr double error_left = 4.5e-6;

/// Node that glides on a plane normal . u = offset (normal of length 1): takes from its velocity what leaves the plane
/// (after Lapeer et al. 2019), and from its displacement most of it. Returns the normal velocity taken; times the mass
/// it is the impulse of the constraint in that step: its reaction m dp/dt^2, without the jumps of dp where the plane
/// itself is renewed.
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

/// Velocity of a node that goes over from one plane to the next of a smooth surface: turned with the normal, so that it
/// keeps its speed, where projecting it would brake it. Where the normals differ by more than 0.3 rad there is an edge,
/// and nothing is turned.
template <class T>
FRONTALIS_LAW Vec3<T> turned_with_normal(const Vec3<T>& from, const Vec3<T>& to, const Vec3<T>& v)
{
  const T cosine = dot(from, to);
  if (!(cosine > Number<T>::of(0.955)))
    return v;
  const Vec3<T> sum = from + to;
  return v - (dot(sum, v) / (cosine + Number<T>::of(1))) * sum + (Number<T>::of(2) * dot(from, v)) * to;
}

/// Coulomb friction in one step: the proportion of its tangential speed that a gliding node loses, from the normal
/// speed that the constraint took from it. 1: it sticks. The mass cancels.
template <class T>
FRONTALIS_LAW T friction_loss(const T& coefficient, const T& normal_speed, const T& tangential_speed)
{
  using N = Number<T>;
  if (mutation::no_friction)
    return N::of(0);
  const T allowed = coefficient * N::max(normal_speed, -normal_speed);
  return N::select(tangential_speed > allowed, allowed / N::max(tangential_speed, allowed), N::of(1));
}

/// How much of a change of the reaction friction takes up in a step dt [s]. Friction that followed the reaction at once
/// would feed the vibrations of an elastic body that slides (the problem is ill-posed) and take the mean of their size
/// for the mean of the reaction; it follows within a millisecond (Prakash & Clifton's law in its simplest form, Cochard
/// & Rice 2000).
template <class T>
FRONTALIS_LAW T friction_response(const T& dt)
{
  return dt / (dt + Number<T>::of(1e-3));
}

}  // namespace physics
}  // namespace frontalis
