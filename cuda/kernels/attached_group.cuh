#pragma once

#include "cuda/kernels/attachment_arguments.hpp"
#include "cuda/kernels/bone_pose.cuh"
#include "frontalis/physics/element/attached_group.hpp"

namespace frontalis
{
namespace cuda
{

/// A group in the form that physics::move_attached_group() reads. Levels are functions of the displacement relative to
/// the surface, which single precision resolves to nanometres.
struct MovedGroup
{
  using Place = physics::Vec3<float>;
  using Motion = physics::PointMotion<float>;
  using Level = physics::MovingLevel<float>;

  const StepArguments& g;
  const AttachedArguments& a;
  const AttachedGroup& group;
  float4* u;  ///< displacements after the update

  __device__ __forceinline__ std::int32_t first() const { return group.first; }
  __device__ __forceinline__ std::int32_t last() const { return group.last; }
  __device__ __forceinline__ float mass() const { return group.mass; }
  __device__ __forceinline__ bool fixed(int axis) const { return (group.fixed >> axis & 1u) != 0; }
  __device__ __forceinline__ bool held(std::int32_t tie) const { return a.ties[tie].plane < 0; }
  __device__ __forceinline__ float ratio(std::int32_t tie) const { return a.ties[tie].ratio; }
  __device__ __forceinline__ float mass(std::int32_t tie) const { return a.ties[tie].mass; }
  __device__ __forceinline__ float offset(std::int32_t tie) const { return a.ties[tie].offset; }

  __device__ __forceinline__ Motion motion_of(std::uint32_t node) const
  {
    const float4 moved = u[node];
    return { { moved.x, moved.y, moved.z }, { g.v[0][node], g.v[1][node], g.v[2][node] } };
  }
  __device__ __forceinline__ void set_motion_of(std::uint32_t node, const Motion& to) const
  {
    u[node] = make_float4(to.u.x, to.u.y, to.u.z, u[node].w);
    g.v[0][node] = to.v.x;
    g.v[1][node] = to.v.y;
    g.v[2][node] = to.v.z;
  }
  __device__ __forceinline__ Motion motion() const { return motion_of(group.master); }
  __device__ __forceinline__ Motion motion(std::int32_t tie) const { return motion_of(a.ties[tie].node); }
  __device__ __forceinline__ void set_motion(const Motion& to) const { set_motion_of(group.master, to); }
  __device__ __forceinline__ void set_motion(std::int32_t tie, const Motion& to) const
  {
    set_motion_of(a.ties[tie].node, to);
  }

  __device__ __forceinline__ Motion bone_at(std::int32_t bone, const float (&rest)[3]) const
  {
    if (bone < 0)
      return { { 0, 0, 0 }, { 0, 0, 0 } };
    const BoneMotion motion = bone_motion_at(g, g.step_begin + 1, bone);
    const Place at{ rest[0], rest[1], rest[2] };
    return { motion.displacement_of(at), motion.velocity_at(at) };
  }
  __device__ __forceinline__ Motion bone_at_node(std::int32_t tie) const
  {
    return bone_at(a.ties[tie].bone, a.ties[tie].rest);
  }
  __device__ __forceinline__ Motion bone_at_master(std::int32_t tie) const
  {
    return bone_at(a.ties[tie].bone, group.rest);
  }

  /// The plane of a node at the displacement `gone` relative to the surface. Where no samples are stored or the
  /// gradient is too short, the latest plane is kept.
  __device__ __forceinline__ physics::KeptLevel<float> kept_level(std::int32_t plane, const Place& gone) const
  {
    physics::KeptLevel<float> level = a.planes[plane];
    if (level.covers(gone))
      return level;
    const AttachedPlace at = a.places[plane];
    const physics::DistanceField& field = g.fields[at.surface];
    const Place offset{ at.offset[0], at.offset[1], at.offset[2] };
    physics::FieldValue<float> value{};
    if (field.radius > 0)
      value = physics::sphere_value(at.distance, offset, gone);
    else if (!physics::sample(field, { { at.cell[0], at.cell[1], at.cell[2] }, offset + gone }, value))
      return level;
    physics::renew_level(value, gone, level);
    a.planes[plane] = level;
    return level;
  }
  __device__ __forceinline__ Level level_at(std::int32_t plane, std::int32_t bone, const float (&rest)[3],
                                            const Place& moved) const
  {
    if (bone < 0)
    {
      const physics::KeptLevel<float> level = kept_level(plane, moved);
      return { level.gradient, { 0, 0, 0 }, level.level_at(moved) };
    }
    const BoneMotion motion = bone_motion_at(g, g.step_begin + 1, bone);
    const Place at{ rest[0], rest[1], rest[2] }, gone = motion.gone(at, moved);
    const physics::KeptLevel<float> level = kept_level(plane, gone);
    return { motion.turned(level.gradient), motion.velocity_at(at + gone), level.level_at(gone) };
  }
  __device__ __forceinline__ Level level_of_node(std::int32_t tie, const Place& moved) const
  {
    return level_at(a.ties[tie].plane, a.ties[tie].bone, a.ties[tie].rest, moved);
  }
  __device__ __forceinline__ Level level_of_master(std::int32_t tie, const Place& moved) const
  {
    return level_at(a.ties[tie].master_plane, a.ties[tie].bone, group.rest, moved);
  }
};

/// Applies the constraints of one group in the launch's only step.
__device__ __forceinline__ void follow_master(const StepArguments& g, const AttachedArguments& a, std::uint32_t index)
{
  const AttachedGroup group = a.groups[index];
  MovedGroup moved{ g, a, group, g.u[1 - g.first] };
  physics::move_attached_group(moved, g.dt);
}

}  // namespace cuda
}  // namespace frontalis
