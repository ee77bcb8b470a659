#include "solver/contact/pushed_contact.hpp"

#include <cmath>

namespace frontalis
{

using Vector = physics::Vec3<double>;

RigidTransform held_pose(const Contact& contact, const std::vector<RigidTransform>& bones)
{
  return contact.bone < 0 ? RigidTransform() : bones[contact.bone];
}

BodyState moved_on(const Contact& contact, const BodyState& before, const Reaction& reaction,
                   const std::vector<RigidTransform>& bones)
{
  BodyState after{ held_pose(contact, bones), 0, 0, 0, { 0, 0, 0 }, { 0, 0, 0 } };
  if (!(contact.mass > 0))
    return after;
  after.held_at = vector_of(after.pose(contact.centre));
  if (!(before.dt > 0))
    return after;
  const Vector centre = vector_of(before.pose(contact.centre));
  const Vector held_velocity = (1 / before.dt) * (after.held_at - before.held_at);
  const Vector force =
      vector_of(contact.force) + vector_of(reaction.force) + contact.spring * (before.held_at - centre);
  const double inertia = contact.mass / before.kick, half = 0.5 * contact.damping;
  after.velocity =
      (1 / (inertia + half)) * ((inertia - half) * before.velocity + force + contact.damping * held_velocity);
  add_vector(after.pose.translation, centre + before.dt * after.velocity - after.held_at);
  return after;
}

double longest_pushed_step(const Contact& contact, double stiffness)
{
  return 2 * std::sqrt(contact.mass / ((1 + 1 / pushed_share) * stiffness + contact.spring));
}

}  // namespace frontalis
