#include "solver/contact/pushed_contact.hpp"

#include <cmath>

namespace frontalis
{

RigidTransform held_pose(const Contact& contact, const std::vector<RigidTransform>& bones)
{
  return contact.bone < 0 ? RigidTransform() : bones[contact.bone];
}

physics::Vec3<double> held_centre(const Contact& contact, const std::vector<RigidTransform>& bones)
{
  return vector_of(held_pose(contact, bones)(contact.centre));
}

physics::PushedBody<double> pushed_body(const Contact& contact)
{
  return { contact.mass, contact.spring, contact.damping, vector_of(contact.force) };
}

double energy_of(const Contact& contact, const physics::PushedMotion<double>& motion)
{
  return contact.mass > 0 && motion.dt > 0 ? physics::energy(pushed_body(contact), motion) : 0;
}

RigidTransform pushed_pose(const Contact& contact, const physics::PushedMotion<double>& motion,
                           const std::vector<RigidTransform>& bones)
{
  RigidTransform pose = held_pose(contact, bones);
  add_vector(pose.translation, motion.centre - motion.held_at);
  return pose;
}

BodyState moved_on(const Contact& contact, const BodyState& before, const Reaction& reaction,
                   const std::vector<RigidTransform>& bones)
{
  BodyState after{ {}, held_pose(contact, bones), 0 };
  if (!(contact.mass > 0))
    return after;
  static_cast<physics::PushedMotion<double>&>(after) =
      physics::moved_on(pushed_body(contact), before, vector_of(reaction.force), held_centre(contact, bones));
  after.pose = pushed_pose(contact, after, bones);
  return after;
}

double longest_pushed_step(const Contact& contact, double stiffness)
{
  return 2 * std::sqrt(contact.mass / ((1 + 1 / pushed_share) * stiffness + contact.spring));
}

}  // namespace frontalis
