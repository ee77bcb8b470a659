#pragma once

#include "frontalis/physics/attachment.hpp"

namespace frontalis
{
namespace physics
{

// One step of a master and of the nodes that follow it. A held node keeps `ratio` times the master's displacement
// relative to its bone. A sliding node keeps `ratio` times the master's distance from the surface, and is free along
// the surface. A node that is joined to its master is held with the ratio 1 by a bone that stands still.

/// Changes the velocities of a group after the free update of a step, so that they are those which the constraints
/// allow and which minimise the sum of mass times |v - v*|^2 over the group, where v* is a velocity before the change
/// (Gauss's principle). Displacements follow. Group is a type of the backend with the members
/// - first(), last(), stride(): the ties of this thread, one per node that follows; several threads may share a group;
/// - join(balance): adds the sums of these threads, so that each has that of the group;
/// - mass(), fixed(axis): the master's mass [kg], and whether it has a prescribed path along an axis;
/// - motion(), set_motion(m): the master's PointMotion;
/// - held(tie), ratio(tie), mass(tie), offset(tie): of a node that follows; offset: level_offset() if it slides [m];
/// - motion(tie), set_motion(tie, m): its PointMotion;
/// - bone_at_node(tie), bone_at_master(tie): PointMotion of a held node's bone at both rest positions;
/// - level_of_node(tie, u), level_of_master(tie, u): MovingLevel at a displacement u; the gradient may be zero.
template <class Group, class T>
FRONTALIS_LAW void move_attached_group(Group& group, const T& dt)
{
  using N = Number<T>;
  const PointMotion<T> before = group.motion();
  Balance<T> balance;
  for (auto tie = group.first(); tie < group.last(); tie += group.stride())
  {
    const T r = group.ratio(tie);
    const PointMotion<T> node = group.motion(tie);
    if (group.held(tie))
    {
      const Vec3<T> apart = node.v - group.bone_at_node(tie).v, wanted = before.v - group.bone_at_master(tie).v;
      balance.add(r * r * group.mass(tie), (r * group.mass(tie)) * (apart - r * wanted));
      continue;
    }
    const MovingLevel<T> own = group.level_of_node(tie, node.u), masters = group.level_of_master(tie, before.u);
    const T steepness = dot(own.gradient, own.gradient);
    if (steepness > T(0))
      balance.add(group.mass(tie) / steepness, r * masters.gradient,
                  dot(own.gradient, node.v - own.surface_velocity) -
                      r * dot(masters.gradient, before.v - masters.surface_velocity));
  }
  group.join(balance);
  balance.add(group.mass(), { T(0), T(0), T(0) });
  for (int axis = 0; axis < 3; ++axis)
    if (group.fixed(axis))
      balance.fix(axis);
  const Vec3<T> change = balance.change(), shift = dt * change;
  const PointMotion<T> after{ before.u + shift, before.v + change };
  group.set_motion(after);
  for (auto tie = group.first(); tie < group.last(); tie += group.stride())
  {
    const T r = group.ratio(tie);
    if (group.held(tie))
    {
      const PointMotion<T> at_node = group.bone_at_node(tie), at_master = group.bone_at_master(tie);
      group.set_motion(tie, { at_node.u + r * (after.u - at_master.u), at_node.v + r * (after.v - at_master.v) });
      continue;
    }
    const PointMotion<T> node = group.motion(tie);
    const MovingLevel<T> own = group.level_of_node(tie, node.u), masters = group.level_of_master(tie, before.u);
    const T steepness = dot(own.gradient, own.gradient);
    if (!(steepness > T(0)))
      continue;
    const T speed = r * dot(masters.gradient, after.v - masters.surface_velocity) -
                    dot(own.gradient, node.v - own.surface_velocity);
    const T apart = own.level + dt * speed - r * (masters.level + dot(masters.gradient, shift)) - group.offset(tie);
    // An error of the level is removed gradually, as for other sliding nodes (physics/sliding.hpp).
    const T left = N::max(N::min(N::of(0.5) * apart, N::of(error_left)), N::of(-error_left));
    group.set_motion(tie, { node.u + ((dt * speed - (apart - left)) / steepness) * own.gradient,
                            node.v + (speed / steepness) * own.gradient });
  }
}

}  // namespace physics
}  // namespace frontalis
