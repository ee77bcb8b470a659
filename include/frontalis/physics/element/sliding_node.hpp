#pragma once

#include "frontalis/physics/pose.hpp"
#include "frontalis/physics/sliding.hpp"

namespace frontalis
{
namespace physics
{

// A node that slides on a surface, in one step: slide() puts it back to its tangent plane, rub() slows it down. The
// step of a node on a bone is that in the bone's frame, between relative_to() and the way back through the pose.

/// Turns the velocity of a node with its plane. Returns the normal speed that this took from it, which is a part of the
/// surface's reaction.
template <class T>
FRONTALIS_LAW T turn_with_plane(const Vec3<T>& from, const Vec3<T>& to, Vec3<T>& v)
{
  const T before = dot(to, v);
  v = turned_with_normal(from, to, v);
  return before - dot(to, v);
}

/// Friction on a node that slides with velocity v relative to the surface. response: friction_response(); reaction:
/// normal speed that the surface took from the node over dt [m/s2]; pressing: as much of it as friction knows of.
template <class T>
FRONTALIS_LAW void rub(const T& coefficient, const T& response, const T& dt, const T& reaction, T& pressing, Vec3<T>& u,
                       Vec3<T>& v)
{
  pressing = pressing + response * (reaction - pressing);
  const Vec3<T> lost = friction_loss(coefficient, dt * pressing, norm(v)) * v;
  v = v - lost;
  u = u - dt * lost;
}

/// What friction takes from a node over its mass [m2/s2]: the impulse along the surface, times the mean of the
/// velocities before the step and after it, relative to the surface. `free`: velocity without constraints.
FRONTALIS_LAW double friction_work(const Vec3<double>& normal, const Vec3<double>& surface_velocity,
                                   const Vec3<double>& before, const Vec3<double>& free, const Vec3<double>& after)
{
  const Vec3<double> change = after - free, along = change - dot(change, normal) * normal;
  return -dot(along, 0.5 * (before + after) - surface_velocity);
}

/// A node as seen from a bone.
struct RelativeMotion
{
  Vec3<double> place, velocity;   ///< in the frame of the bone [m], relative to it [m/s]
  Vec3<double> surface_velocity;  ///< of the bone where the node is, in the scene's frame [m/s]
};

/// now, before: of the bone at the end of the step and at its begin; rate: 1 / dt; place, v: of the node after its
/// update.
FRONTALIS_LAW RelativeMotion relative_to(const Pose& now, const Pose& before, double rate, const Vec3<double>& place,
                                         const Vec3<double>& v)
{
  const Vec3<double> p = now.inwards(place);
  const Vec3<double> surface_velocity = rate * (now.outwards(p) - before.outwards(p));
  return { p, now.turned_back(v - surface_velocity), surface_velocity };
}

}  // namespace physics
}  // namespace frontalis
