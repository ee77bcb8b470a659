#pragma once

#include "frontalis/physics/attachment.hpp"

namespace frontalis
{
namespace physics
{

// One step of a master and of the nodes that follow it. A held node keeps `ratio` times the master's displacement
// relative to its bone. A sliding node keeps `ratio` times the master's distance from the surface, and is free along
// the surface. A node that is joined to its master is held with the ratio 1 by a bone that stands still.

/// A node that follows, before the change of its group.
template <class T>
struct FollowingNode
{
  /// Of a sliding node, the gradients of its level and of its master's. Of a held node, what its bone adds to `ratio`
  /// times the displacement and the velocity of the master.
  Vec3<T> own, masters;
  T steepness;  ///< of a sliding node: squared gradient of its level
  T apart;      ///< by how much its level exceeds `ratio` times the master's and the offset [m]
  T excess;     ///< rate of that [m/s]
};

template <class Group, class Tie, class T>
FRONTALIS_LAW FollowingNode<T> following_node(const Group& group, const Tie& tie, const PointMotion<T>& master)
{
  const T r = group.ratio(tie);
  if (group.held(tie))
  {
    PointMotion<T> at_node, at_master;
    group.bone_at(tie, at_node, at_master);
    return { at_node.u - r * at_master.u, at_node.v - r * at_master.v, T(0), T(0), T(0) };
  }
  const PointMotion<T> node = group.motion(tie);
  MovingLevel<T> own, masters;
  group.levels(tie, node.u, master.u, own, masters);
  return { own.gradient, masters.gradient, dot(own.gradient, own.gradient),
           own.level - r * masters.level - group.offset(tie),
           dot(own.gradient, node.v - own.surface_velocity) -
               r * dot(masters.gradient, master.v - masters.surface_velocity) };
}

/// Changes the velocities of a group after the free update of a step, so that they are those which the constraints
/// allow and which minimise the sum of mass times |v - v*|^2 over the group, where v* is a velocity before the change
/// (Gauss's principle). Displacements follow. Group is a type of the backend with the members
/// - first(), last(), stride(): the ties of this thread, one per node that follows; several threads may share a group;
/// - join(balance): adds the sums of these threads, so that each has that of the group;
/// - mass(), fixed(axis): the master's mass [kg], and whether it has a prescribed path along an axis;
/// - motion(), set_motion(m): the master's PointMotion;
/// - held(tie), ratio(tie), mass(tie), offset(tie): of a node that follows; offset: level_offset() if it slides [m];
/// - motion(tie), set_motion(tie, m): its PointMotion;
/// - bone_at(tie, node, master): finds the PointMotion of a held node's bone at both rest positions;
/// - levels(tie, u, master_u, own, masters): finds the MovingLevel of a sliding node and of its master at displacements
///   of both; gradients may be zero.
template <class Group, class T>
FRONTALIS_LAW void move_attached_group(Group& group, const T& dt)
{
  using N = Number<T>;
  Balance<T> balance;
  // On a GPU a thread mostly has one tie. What is found for the first one is kept, because a second look takes as long.
  FollowingNode<T> first{};
  const PointMotion<T> before = group.motion();
  for (auto tie = group.first(); tie < group.last(); tie += group.stride())
  {
    const T r = group.ratio(tie), mass = group.mass(tie);
    const FollowingNode<T> node = following_node(group, tie, before);
    if (tie == group.first())
      first = node;
    if (group.held(tie))
      balance.add(r * r * mass, (r * mass) * (group.motion(tie).v - node.masters - r * before.v));
    else if (node.steepness > T(0))
      balance.add(mass / node.steepness, r * node.masters, node.excess);
  }
  group.join(balance);
  balance.add(group.mass(), { T(0), T(0), T(0) });
  for (int axis = 0; axis < 3; ++axis)
    if (group.fixed(axis))
      balance.fix(axis);
  const Vec3<T> change = balance.change();
  const PointMotion<T> after{ before.u + dt * change, before.v + change };
  group.set_motion(after);
  for (auto tie = group.first(); tie < group.last(); tie += group.stride())
  {
    const T r = group.ratio(tie);
    const FollowingNode<T> node = tie == group.first() ? first : following_node(group, tie, before);
    if (group.held(tie))
    {
      group.set_motion(tie, { node.own + r * after.u, node.masters + r * after.v });
      continue;
    }
    if (!(node.steepness > T(0)))
      continue;
    const T speed = r * dot(node.masters, change) - node.excess, apart = node.apart - dt * node.excess;
    // An error of the level is removed gradually, as for other sliding nodes (physics/sliding.hpp).
    const T left = N::max(N::min(N::of(0.5) * apart, N::of(error_left)), N::of(-error_left));
    const PointMotion<T> motion = group.motion(tie);
    group.set_motion(tie, { motion.u + ((dt * speed - (apart - left)) / node.steepness) * node.own,
                            motion.v + (speed / node.steepness) * node.own });
  }
}

}  // namespace physics
}  // namespace frontalis
