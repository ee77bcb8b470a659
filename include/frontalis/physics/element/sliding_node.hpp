#pragma once

#include "frontalis/physics/pose.hpp"
#include "frontalis/physics/sliding.hpp"

namespace frontalis
{
namespace physics
{

// One step of a node that slides on a surface: slide() moves it back to its tangent plane, rub() applies friction.

/// Rotates a node's velocity as its tangent plane rotates from the normal `from` to the normal `to`. Returns the normal
/// speed that this removes, a part of the surface's reaction.
template <class T>
FRONTALIS_LAW T turn_with_plane(const Vec3<T>& from, const Vec3<T>& to, Vec3<T>& v)
{
  const T before = dot(to, v);
  v = turned_with_normal(from, to, v);
  return before - dot(to, v);
}

/// Applies friction to a node with velocity v relative to the surface. response: friction_response(); reaction: normal
/// speed that the surface removed, divided by dt [m/s2]; pressing: the low-pass filtered reaction, which determines
/// friction and is updated here.
template <class T>
FRONTALIS_LAW void rub(const T& coefficient, const T& response, const T& dt, const T& reaction, T& pressing, Vec3<T>& u,
                       Vec3<T>& v)
{
  pressing = pressing + response * (reaction - pressing);
  const Vec3<T> lost = friction_loss(coefficient, dt * pressing, norm(v)) * v;
  v = v - lost;
  u = u - dt * lost;
}

/// The level set on which a node slides near the displacement `reference`, to second order: the field's value and
/// gradient divided by the gradient's length there are normal . u - offset + way . bend way / 2 and normal + bend way,
/// with way = u - reference.
template <class T>
struct CurvedLevel
{
  Vec3<T> normal;
  T offset;  ///< [m]
  Vec3<T> reference;
  SymmetricMatrix<T> bend;   ///< [1/m]
  Vec3<T> surface_velocity;  ///< [m/s]

  /// The unit normal at the displacement u, and the distance from the level set along it [m].
  FRONTALIS_LAW void at(const Vec3<T>& u, Vec3<T>& normal_there, T& distance) const
  {
    using N = Number<T>;
    const Vec3<T> way = u - reference, turn = bend * way, gradient = normal + turn;
    const T scale = N::of(1) / N::max(norm(gradient), N::of(1e-6));
    normal_there = scale * gradient;
    distance = scale * (dot(normal, u) - offset + N::of(0.5) * dot(way, turn));
  }
};

/// One step of a node on a surface with friction. Its plane turns with the level set, since the reaction would jump if
/// a plane that was kept for several steps were replaced, and friction follows the reaction. `outward`: the normal of
/// the step before, and then of this one; 0: none. A level whose normal is 0 changes nothing.
template <class T>
FRONTALIS_LAW void glide(const CurvedLevel<T>& level, const T& coefficient, const T& response, const T& dt,
                         Vec3<T>& outward, T& pressing, Vec3<T>& u, Vec3<T>& v)
{
  Vec3<T> normal;
  T distance;
  level.at(u, normal, distance);
  Vec3<T> velocity = v - level.surface_velocity;
  T taken = turn_with_plane(outward, normal, velocity);
  taken = taken + slide(normal, dot(normal, u) - distance, u, velocity);
  rub(coefficient, response, dt, taken / dt, pressing, u, velocity);
  outward = normal;
  v = velocity + level.surface_velocity;
}

/// Energy per mass that friction dissipates at a node [m2/s2]: the impulse along the surface times the mean of the
/// velocities before and after the step, relative to the surface. `free`: velocity without constraints.
FRONTALIS_LAW double friction_work(const Vec3<double>& normal, const Vec3<double>& surface_velocity,
                                   const Vec3<double>& before, const Vec3<double>& free, const Vec3<double>& after)
{
  const Vec3<double> change = after - free, along = change - dot(change, normal) * normal;
  return -dot(along, 0.5 * (before + after) - surface_velocity);
}

/// Velocity [m/s] of a bone at the place p [m], p in the bone's frame, from its poses at the end and start of the step;
/// rate: 1 / dt.
FRONTALIS_LAW Vec3<double> surface_velocity(const Pose& now, const Pose& before, double rate, const Vec3<double>& p)
{
  return rate * (now.outwards(p) - before.outwards(p));
}

}  // namespace physics
}  // namespace frontalis
