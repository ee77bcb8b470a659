#pragma once

#include "cuda/kernels/step_kernel.hpp"
#include "frontalis/model/sample_field.hpp"
#include "solver/contact/body_contact.hpp"

#include <array>
#include <cstring>
#include <vector>

namespace frontalis
{
namespace cuda
{

/// Contact on the host, which sums reactions and energies from the forces that the device finds.
using HostContact = BodyContact<double>;

/// A body in the form that the device needs. `field`: the body's distance field in device memory.
inline ContactBody contact_body(const Contact& contact, const physics::DistanceField& field)
{
  ContactBody body{ field,
                    contact.field.radius > 0 ? 0 : static_cast<float>(1 / contact.field.spacing),
                    static_cast<float>(contact.reach),
                    static_cast<float>(contact.friction),
                    contact.bone,
                    {} };
  for (const auto& point : contact.points)
    for (std::size_t axis = 0; axis < 3; ++axis)
      body.middle[axis] += point[axis] / static_cast<double>(contact.points.size());
  return body;
}

/// Numbers of floats of a pose, and of a bone's pose with its motion.
constexpr std::size_t pose_entries = 12, bone_motion_entries = 24;

/// Writes a pose in the form of BodyPose (cuda/kernels/bone_pose.cuh): three rows, each with a component of the shift.
/// Returns the end of what it has written, as the next function does.
inline float* put_pose(const RigidTransform& pose, const double (&middle)[3], float* to)
{
  for (std::size_t i = 0; i < 3; ++i)
  {
    double shift = -middle[i];
    for (std::size_t j = 0; j < 3; ++j)
    {
      const double turn = pose.rotation[3 * j + i];
      *to++ = static_cast<float>(turn - (i == j ? 1 : 0));
      shift += turn * (middle[j] - pose.translation[j]);
    }
    *to++ = static_cast<float>(shift);
  }
  return to;
}

/// Appends the pose of a body (ContactArguments::poses).
inline void add_pose(const ContactBody& body, const std::vector<RigidTransform>& bones, std::vector<float>& to)
{
  to.resize(to.size() + pose_entries);
  put_pose(body.bone < 0 ? RigidTransform() : bones[body.bone], body.middle, &to.back() + 1 - pose_entries);
}

/// Writes a bone's pose after a step, and its motion in the step (StepArguments::bone_motions). `rate`: 1 over the
/// length of the step [1/s].
inline float* put_bone_motion(const RigidTransform& before, const RigidTransform& after, double rate, float* to)
{
  to = put_pose(after, { 0, 0, 0 }, to);
  for (std::size_t i = 0; i < 3; ++i)
  {
    for (std::size_t j = 3 * i; j < 3 * i + 3; ++j)
      *to++ = static_cast<float>(rate * (after.rotation[j] - before.rotation[j]));
    *to++ = static_cast<float>(rate * (after.translation[i] - before.translation[i]));
  }
  return to;
}

/// A point in the form that the device needs.
inline ContactPoint contact_point(const Contact& contact, const ContactBody& body, const HostContact::Point& from)
{
  const auto at = physics::field_point(view(contact.field), from.rest);
  const auto& c = from.coordinates;
  return { { c[0], c[1], c[2] },
           from.stiffness,
           { static_cast<float>(at.offset.x), static_cast<float>(at.offset.y), static_cast<float>(at.offset.z) },
           from.body,
           { static_cast<float>(from.rest.x - body.middle[0]), static_cast<float>(from.rest.y - body.middle[1]),
             static_cast<float>(from.rest.z - body.middle[2]) },
           static_cast<float>(norm(at.offset) - contact.field.radius),
           { at.cell[0], at.cell[1], at.cell[2] },
           static_cast<float>(counted(contact) * double(from.stiffness)) };
}

/// The initial content of a point's copy of samples (see sample_words). It says that no samples are stored yet.
inline std::array<float4, sample_words> no_samples()
{
  std::array<float4, sample_words> words{};
  std::memcpy(&words.back().w, &no_cell, sizeof no_cell);
  return words;
}

/// Result of a step for a point, in the form that the host needs.
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
