#pragma once

#include "cuda/kernels/bone_pose.cuh"
#include "cuda/kernels/bound_points.cuh"
#include "cuda/kernels/kept_samples.cuh"

namespace frontalis
{
namespace cuda
{

// Points of the tissue that may touch bodies. They follow the same rules as the points of BodyContact, in single
// precision. Positions are relative to rest, so that they are exact to nanometres.

/// Pose of a body at the start of a step.
__device__ __forceinline__ BodyPose body_pose_at(const StepArguments& g, int step, std::int32_t body)
{
  BodyPose pose;
  read_rows(g.contact.poses + 3 * (static_cast<std::size_t>(step) * g.contact.body_count + body), pose.less,
            pose.shift);
  return pose;
}

/// Copies the samples of another cell to a point's own copy. Returns false, and copies nothing, if the cell has no
/// samples.
static __device__ __noinline__ bool enter_contact_cell(const ContactArguments& c, std::uint32_t index,
                                                       std::uint32_t code)
{
  const ContactPoint& point = c.points[index];
  const KeptSamples kept{ c.samples, c.point_count, index };
  if (!kept.copy(c.bodies[point.body].field, point.cell, code, 0))
    return false;
  kept.number(27) = __uint_as_float(code);
  return true;
}

/// Finds the field of the point's body at the point, which has moved by `gone` in the body's frame. Returns false if no
/// samples are stored there.
__device__ __forceinline__ bool distance_at(const ContactArguments& c, std::uint32_t index, const ContactPoint& point,
                                            const ContactBody& body, const physics::Vec3<float>& gone,
                                            physics::FieldValue<float>& value)
{
  const physics::Vec3<float> offset{ point.offset[0], point.offset[1], point.offset[2] };
  if (body.inverse_spacing == 0)
  {
    value = physics::sphere_value(point.distance, offset, gone);
    return true;
  }
  const KeptSamples kept{ c.samples, c.point_count, index };
  return kept.value_at(body.inverse_spacing, offset + gone, __float_as_uint(kept.number(27)), value,
                       [&](std::uint32_t code) { return aside(enter_contact_cell)(c, index, code); });
}

/// A point's position relative to the origin of its body's frame [m].
__device__ __forceinline__ physics::Vec3<float> from_body(const StepArguments& g, int step, const ContactBody& body,
                                                          const ContactPoint& point, const physics::Vec3<float>& moved)
{
  const physics::Vec3<double> middle{ body.middle[0], body.middle[1], body.middle[2] };
  const physics::Vec3<float> back = body_pose_at(g, step, point.body).back_to_rest(middle);
  return { static_cast<float>(middle.x + double(point.arm[0]) + double(moved.x) + double(back.x)),
           static_cast<float>(middle.y + double(point.arm[1]) + double(moved.y) + double(back.y)),
           static_cast<float>(middle.z + double(point.arm[2]) + double(moved.z) + double(back.z)) };
}

/// A point of contact in one step.
struct PointStep
{
  std::uint32_t index;
  int step;
  bool last;                   ///< whether the step is the last one of the launch, whose forces the host reads
  physics::Vec3<float> moved;  ///< displacement at the start of the step [m]
};

/// How a body pushes a point in one step.
struct Push
{
  physics::Vec3<float> force;  ///< force on the point [N]
  float free_way;              ///< distance by which the point may move before it must be evaluated again [m]
};

/// Stores the force on a point for the host if the step is the last one of the launch.
__device__ __forceinline__ void leave_force(const StepArguments& g, const PointStep& at, const ContactPoint& point,
                                            const ContactBody& body, const physics::Vec3<float>& force, float lost)
{
  if (!at.last)
    return;
  const physics::Vec3<float> arm = from_body(g, at.step, body, point, at.moved);
  g.contact.forces[at.index] = make_float4(force.x, force.y, force.z, lost);
  g.contact.arms[at.index] = make_float4(arm.x, arm.y, arm.z, 0);
}

/// Finds the force on a point, which is zero if it does not touch.
__device__ __forceinline__ Push find_push(const StepArguments& g, const ContactPoint& point, const PointStep& at)
{
  using Place = physics::Vec3<float>;
  using physics::Touching;
  const ContactArguments& c = g.contact;
  if (c.spring)
    return { -point.spring * at.moved, 0 };
  const float4 held = c.grips[at.index], clear = c.clearances[at.index];
  ContactHold hold = c.holds[at.index];
  const ContactBody& body = c.bodies[point.body];
  const BodyPose pose = body_pose_at(g, at.step, point.body);
  const Place gone = pose.gone({ point.arm[0], point.arm[1], point.arm[2] }, at.moved);
  const Place away = gone - Place{ clear.x, clear.y, clear.z };
  const bool far = clear.w > 0 && dot(away, away) < clear.w * clear.w;
  if (far && hold.touching == int(Touching::no) && held.w == 0)
    return { { 0, 0, 0 }, fmaxf(clear.w - norm(away), 0) };

  physics::Grip<float> grip{ { held.x, held.y, held.z }, held.w, hold.along };
  const auto response = static_cast<float>(g.friction_response);
  physics::FieldValue<float> value{};
  const bool sampled = !far && distance_at(c, at.index, point, body, gone, value);
  if (sampled && value.value < 0)
  {
    if (hold.touching != int(Touching::yes))
      grip = { gone, grip.normal, 0 };
    const auto touch = physics::touch<float>(value, gone, grip, point.stiffness, body.friction, response);
    c.grips[at.index] = make_float4(touch.grip.anchor.x, touch.grip.anchor.y, touch.grip.anchor.z, touch.grip.normal);
    c.holds[at.index] = { touch.grip.along, int(Touching::yes) };
    const Place force = pose.turned(touch.force);
    leave_force(g, at, point, body, force, touch.lost);
    return { force, 0 };
  }
  const float lost = physics::let_go(grip, point.stiffness, response);
  if (!(body.friction > 0 && grip.normal > point.stiffness * static_cast<float>(physics::forgotten_depth)))
    grip.normal = 0;
  const bool was_inside = hold.touching == int(Touching::yes) || hold.touching == int(Touching::lost);
  const bool lost_inside = was_inside && !sampled && !far;
  hold.touching = int(lost_inside ? Touching::lost : was_inside ? Touching::let_go : Touching::no);
  c.grips[at.index] = make_float4(held.x, held.y, held.z, grip.normal);
  c.holds[at.index] = { grip.along, hold.touching };
  float distance = 0;
  if (lost_inside)
    c.clearances[at.index].w = 0;
  else if (!far)
  {
    // The factor 0.999 makes the result a lower bound of the distance despite rounding errors.
    distance = 0.999f * (sampled ? value.value / static_cast<float>(physics::steepest_field)
                                 : static_cast<float>(physics::distance_without_samples(
                                       body.field, double(body.reach),
                                       physics::Vec3<double>{ body.middle[0], body.middle[1], body.middle[2] } +
                                           physics::Vec3<double>{ double(point.arm[0]) + double(gone.x),
                                                                  double(point.arm[1]) + double(gone.y),
                                                                  double(point.arm[2]) + double(gone.z) })));
    c.clearances[at.index] = make_float4(gone.x, gone.y, gone.z, distance);
  }
  leave_force(g, at, point, body, { 0, 0, 0 }, lost);
  return { { 0, 0, 0 }, hold.touching == int(Touching::no) && grip.normal == 0 ? distance : 0 };
}

/// Finds the force on a point in strips, and stores it for push_nodes(). Calls wait(), which waits for the preceding
/// kernel, once constant data have been loaded.
template <class Wait>
__device__ __forceinline__ physics::Vec3<float> put_push(const StepArguments& g, std::uint32_t index,
                                                         const ContactPoint& point, int step, const Wait& wait)
{
  const BoundPoints& bound = g.contact.bound;
  const float4 coordinates = bound.coordinates[index];
  const uint4 low = bound.nodes[2 * index], high = bound.nodes[2 * index + 1];
  wait();
  const physics::Vec3<float> moved = bound_displacement(coordinates, low, high, g.u[g.first]);
  const physics::Vec3<float> force = find_push(g, point, { index, step, true, moved }).force;
  bound.pushes[index] = make_float4(force.x, force.y, force.z, 0);
  return force;
}

}  // namespace cuda
}  // namespace frontalis
