#pragma once

#include "cuda/kernels/contact_arguments.hpp"
#include "frontalis/model/sample_field.hpp"
#include "solver/contact/body_contact.hpp"

namespace frontalis
{
namespace cuda
{

/// Contact on the host: it keeps the account of what the device finds.
using HostContact = BodyContact<double>;

/// A body in the form of the device, with its field there.
inline ContactBody contact_body(const Contact& contact, const physics::DistanceField& field)
{
  return { field, static_cast<float>(1 / contact.field.spacing), static_cast<float>(contact.reach),
           static_cast<float>(contact.friction) };
}

/// A point of the host in the form of the device.
inline ContactPoint contact_point(const Contact& contact, const HostContact::Point& from)
{
  const auto at = physics::field_point(view(contact.field), from.rest);
  const auto& c = from.coordinates;
  return { { c[0], c[1], c[2] },
           from.stiffness,
           { static_cast<float>(at.offset.x), static_cast<float>(at.offset.y), static_cast<float>(at.offset.z) },
           from.body,
           { at.cell[0], at.cell[1], at.cell[2] },
           contact.bone,
           { from.rest.x, from.rest.y, from.rest.z } };
}

/// What a step has left of a point, in the form of the host.
inline HostContact::Found found_at(const ContactArguments& contact, std::size_t index, const HostContact::Point& point)
{
  const auto vector = [](const float4& v) { return physics::Vec3<double>{ double(v.x), double(v.y), double(v.z) }; };
  const float4 &force = contact.forces[index], &grip = contact.grips[index];
  const ContactHold& hold = contact.holds[index];
  return { { vector(force), vector(contact.arms[index]), double(force.w) },
           { point.rest + vector(grip), double(grip.w), double(hold.along) },
           static_cast<physics::Touching>(hold.touching) };
}

}  // namespace cuda
}  // namespace frontalis
