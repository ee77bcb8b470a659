#pragma once

#include "cuda/kernels/bone_pose.cuh"
#include "frontalis/physics/trilinear.hpp"

namespace frontalis
{
namespace cuda
{

// Points of the tissue that may touch bodies. What a point does in a step is that of BodyContact::voxel_readings(), in
// single precision. Places are relative to rest, so that they are exact to nanometres.

/// Adds part of a voxel's displacement: corner b of weight w.
__device__ __forceinline__ void add_part(physics::Vec3<float>& sum, float w, const float4& u)
{
  sum = sum + w * physics::Vec3<float>{ u.x, u.y, u.z };
}

/// Weight of corner b of a voxel at coordinates (x, y, z).
__device__ __forceinline__ float corner_weight(std::uint32_t b, float x, float y, float z)
{
  return (b & 1 ? x : 1 - x) * (b & 2 ? y : 1 - y) * (b & 4 ? z : 1 - z);
}

/// Leaves the force of a point in this step.
__device__ __forceinline__ void leave_force(const StepArguments& g, std::uint32_t index, const ContactPoint& point,
                                            const physics::Vec3<float>& moved, int step,
                                            const physics::Vec3<float>& force, float lost)
{
  double origin[3] = { 0, 0, 0 };
  if (point.bone >= 0)
  {
    const Pose pose = pose_at(g, step, point.bone);
    for (int axis = 0; axis < 3; ++axis)
      origin[axis] = pose.t[axis];
  }
  g.contact.forces[index] = make_float4(force.x, force.y, force.z, lost);
  g.contact.arms[index] = make_float4(static_cast<float>(point.rest[0] + double(moved.x) - origin[0]),
                                      static_cast<float>(point.rest[1] + double(moved.y) - origin[1]),
                                      static_cast<float>(point.rest[2] + double(moved.z) - origin[2]), 0);
}

/// Finds the force [N] on a point that has moved by `moved` [m] at the start of a step. Returns false, and leaves
/// `force` as it is, if there is none.
__device__ __forceinline__ bool find_push(const StepArguments& g, std::uint32_t index, const ContactPoint& point,
                                          const physics::Vec3<float>& moved, int step, physics::Vec3<float>& force)
{
  using Point = physics::Vec3<double>;
  using Place = physics::Vec3<float>;
  using physics::Touching;
  const ContactArguments& c = g.contact;
  if (c.spring)
  {
    force = -point.stiffness * moved;
    return true;
  }
  const float4 held = c.grips[index], clear = c.clearances[index];
  ContactHold hold = c.holds[index];
  const Point rest{ point.rest[0], point.rest[1], point.rest[2] };
  Place gone = moved;
  if (point.bone >= 0)
  {
    const Point at = pose_at(g, step, point.bone).inwards(rest + Point{ moved.x, moved.y, moved.z }) - rest;
    gone = { static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z) };
  }
  const Place away = gone - Place{ clear.x, clear.y, clear.z };
  const bool far = dot(away, away) < clear.w * clear.w;
  if (far && hold.touching == int(Touching::no) && held.w == 0)
    return false;

  const ContactBody& body = c.bodies[point.body];
  physics::Grip<float> grip{ { held.x, held.y, held.z }, held.w, hold.along };
  const auto response = static_cast<float>(g.friction_response);
  physics::FieldValue<float> value{};
  const Place offset{ point.offset[0], point.offset[1], point.offset[2] };
  const bool sampled =
      !far && physics::sample(body.field, body.inverse_spacing,
                              { { point.cell[0], point.cell[1], point.cell[2] }, offset + gone }, value);
  if (sampled && value.value < 0)
  {
    if (hold.touching != int(Touching::yes))
      grip = { gone, grip.normal, 0 };
    const auto touch = physics::touch<float>(value, gone, grip, point.stiffness, body.friction, response);
    c.grips[index] = make_float4(touch.grip.anchor.x, touch.grip.anchor.y, touch.grip.anchor.z, touch.grip.normal);
    c.holds[index] = { touch.grip.along, int(Touching::yes) };
    force = touch.force;
    if (point.bone >= 0)
    {
      const Point turned = pose_at(g, step, point.bone).turned({ double(force.x), double(force.y), double(force.z) });
      force = { static_cast<float>(turned.x), static_cast<float>(turned.y), static_cast<float>(turned.z) };
    }
    leave_force(g, index, point, moved, step, force, touch.lost);
    return true;
  }
  const float lost = physics::let_go(grip, point.stiffness, response);
  if (!(body.friction > 0 && grip.normal > point.stiffness * static_cast<float>(physics::forgotten_depth)))
    grip.normal = 0;
  const bool was_inside = hold.touching == int(Touching::yes) || hold.touching == int(Touching::lost);
  const bool lost_inside = was_inside && !sampled && !far;
  hold.touching = int(lost_inside ? Touching::lost : was_inside ? Touching::let_go : Touching::no);
  c.grips[index] = make_float4(held.x, held.y, held.z, grip.normal);
  c.holds[index] = { grip.along, hold.touching };
  if (lost_inside)
    c.clearances[index].w = 0;
  else if (!far)
  {
    const Point place = rest + Point{ gone.x, gone.y, gone.z };
    // a little less, for what rounding takes
    const float way =
        0.999f * (sampled
                      ? value.value / static_cast<float>(physics::steepest_field)
                      : static_cast<float>(physics::distance_without_samples(body.field, double(body.reach), place)));
    c.clearances[index] = make_float4(gone.x, gone.y, gone.z, way);
  }
  leave_force(g, index, point, moved, step, { 0, 0, 0 }, lost);
  return false;
}

}  // namespace cuda
}  // namespace frontalis
