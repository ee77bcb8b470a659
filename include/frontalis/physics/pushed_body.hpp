#pragma once

#include "frontalis/physics/number.hpp"

namespace frontalis
{
namespace physics
{

/// A body that moves under forces. It turns with its bone, but not against it.
template <class T>
struct PushedBody
{
  T mass;         ///< [kg]
  T spring;       ///< stiffness of the spring to the body's place on its bone [N/m]
  T damping;      ///< of the velocity relative to that place [N s/m]
  Vec3<T> force;  ///< constant force [N]
};

/// Motion of a pushed body at the start of a step. All members are 0 before the first step.
template <class T>
struct PushedMotion
{
  Vec3<T> centre;    ///< position of the body's centre [m]
  Vec3<T> held_at;   ///< position that its centre would have if it kept its pose relative to its bone [m]
  Vec3<T> velocity;  ///< half a step earlier [m/s]
  T dt;              ///< length of the step [s]; 0: no step has been made
  T kick;            ///< time over which forces change velocities in the step [s]
};

/// The motion at the end of a step; `dt` and `kick` are 0 until begin_step(). The centre moves by central differences,
/// as nodes do, so that the impulses of body and tissue on each other are exact opposites. Half of the damping acts on
/// the new velocity, so that damping does not limit the time step. `reaction`: force of the tissue at the start of the
/// step [N]; `held_at`: at the end of the step.
template <class T>
FRONTALIS_LAW PushedMotion<T> moved_on(const PushedBody<T>& body, const PushedMotion<T>& before,
                                       const Vec3<T>& reaction, const Vec3<T>& held_at)
{
  PushedMotion<T> after{ held_at, held_at, { T(0), T(0), T(0) }, T(0), T(0) };
  if (!(before.dt > T(0)))
    return after;
  const Vec3<T> held_velocity = (T(1) / before.dt) * (held_at - before.held_at);
  const Vec3<T> force = body.force + reaction + body.spring * (before.held_at - before.centre);
  const T inertia = body.mass / before.kick, half = T(0.5) * body.damping;
  after.velocity =
      (T(1) / (inertia + half)) * ((inertia - half) * before.velocity + force + body.damping * held_velocity);
  after.centre = before.centre + before.dt * after.velocity;
  return after;
}

/// Kinetic energy of the body, and energy of its spring [J].
template <class T>
FRONTALIS_LAW T energy(const PushedBody<T>& body, const PushedMotion<T>& motion)
{
  const Vec3<T> stretched = motion.centre - motion.held_at;
  return T(0.5) * (body.mass * dot(motion.velocity, motion.velocity) + body.spring * dot(stretched, stretched));
}

/// Begins a step of length `dt` [s]. `before`: length of the previous step; 0: there was none.
template <class T>
FRONTALIS_LAW void begin_step(PushedMotion<T>& motion, const T& before, const T& dt)
{
  motion.dt = dt;
  motion.kick = before > T(0) ? T(0.5) * (before + dt) : dt;
}

}  // namespace physics
}  // namespace frontalis
