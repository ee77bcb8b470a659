#pragma once

#include "frontalis/physics/number.hpp"

namespace frontalis
{
namespace physics
{

// How forces and prescribed motions move a node in one step. Displacement u [m] and velocity v [m/s] are those of one
// axis; a backend loops over nodes and axes.

/// How a step of the damped central difference scheme changes velocities: v = keep v + impulse - gain f / m.
template <class T>
struct Kick
{
  T keep, gain;  ///< [-], [s]
  T impulse[3];  ///< gain times gravity [m/s]
};

/// What a step leaves of a velocity without forces. `half`: half of damping times seconds.
FRONTALIS_LAW double kept_velocity(double half)
{
  const double limited = Number<double>::min(half, 0.9);
  return (1 - limited) / (1 + limited);
}

/// `damping`: mass-proportional [1/s]; `seconds`: time over which forces change velocities; gravity [m/s2]. With
/// damping above 1.8 / `seconds`, a step leaves a nineteenth of each velocity, because central differences without this
/// limit could reverse velocities.
template <class T, class Gravity>
Kick<T> kick_of(double damping, double seconds, const Gravity& gravity)
{
  const double half = 0.5 * damping * seconds, gain = seconds / (1 + half);
  Kick<T> kick{ static_cast<T>(kept_velocity(half)), static_cast<T>(gain), {} };
  for (int axis = 0; axis < 3; ++axis)
    kick.impulse[axis] = static_cast<T>(gain * gravity[axis]);
  return kick;
}

/// Velocity of a free node after a step. gain_over_mass: Kick::gain divided by the node's mass [s/kg].
template <class T>
FRONTALIS_LAW T kicked(const Kick<T>& kick, int axis, T v, T gain_over_mass, T force)
{
  return (kick.keep * v + kick.impulse[axis]) - gain_over_mass * force;
}

/// Adds the effect of a load [N] to a node that was moved without the load. The result is exact, because a step is
/// linear in the force.
template <class T>
FRONTALIS_LAW void add_load(T gain_over_mass, T dt, T force, T& u, T& v)
{
  const T change = gain_over_mass * force;
  v += change;
  u += dt * change;
}

/// Moves a node that follows a bone or a prescribed path. before: its displacement before the step.
template <class T>
FRONTALIS_LAW void move_to(double to, T before, T dt, T& u, T& v)
{
  u = static_cast<T>(to);
  v = (u - before) / dt;
}

/// Work on a node in one step, along one axis and divided by the node's mass [m2/s2].
struct NodeWork
{
  double damping;     ///< lost to damping
  double constraint;  ///< work of constraints
};

/// Finds the work on a node from its velocities [m/s] before the step (`before`), after the step (`after`), and as they
/// would be after the step without constraints (`free`). Each impulse acts along the mean of the velocities before and
/// after the step, so that the works add up to the change of kinetic energy exactly. `beside`, `beside_before`:
/// displacement [m] that constraints made in addition to dt v, in this step and in the previous one. The mean of the
/// other forces over both steps did work along this displacement too, which the constraints absorbed. `damping` [1/s],
/// `kick` [s]: the first two arguments of kick_of().
FRONTALIS_LAW NodeWork node_work(double before, double free, double after, double beside, double beside_before,
                                 double damping, double kick)
{
  const double mean = 0.5 * (before + after), half = 0.5 * damping * kick,
               from_before = (1 - (1 + half) * kept_velocity(half)) * before;
  // The other forces changed `free`; damping acts on the velocities that the node had.
  const double others = free - before + half * free + from_before;
  return { mean * (half * after + from_before),
           mean * (1 + half) * (after - free) - others * 0.5 * (beside + beside_before) / kick };
}

}  // namespace physics
}  // namespace frontalis
