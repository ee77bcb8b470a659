#pragma once

#include "cuda/kernels/attachment_arguments.hpp"
#include "cuda/kernels/bone_pose.cuh"
#include "frontalis/physics/element/attached_group.hpp"

namespace frontalis
{
namespace cuda
{

/// Number of neighbouring threads that share a group, a power of 2. Most groups have no more nodes, so that their loads
/// do not wait for each other.
constexpr int group_lanes = 8;

/// Where the groups of a launch or of a patch are. Indices are those of AttachedArguments.
struct GroupTables
{
  const AttachedGroup* groups;
  const AttachedTie* ties;
  physics::KeptLevel<float>* planes;  ///< the same as AttachedArguments::planes, or a copy of them
};

/// A group in the form that physics::move_attached_group() reads. Levels are functions of the displacement relative to
/// the surface, which single precision resolves to nanometres.
template <int Lanes>
struct MovedGroup
{
  using Place = physics::Vec3<float>;
  using Motion = physics::PointMotion<float>;
  using Level = physics::MovingLevel<float>;

  const StepArguments& g;
  const GroupTables& tables;
  const AttachedGroup& group;
  // Displacements and velocities after the update, indexed by device node:
  float4* u;
  float* const (&v)[3];
  int step;
  int lane;  ///< of the `Lanes` threads of the group

  __device__ __forceinline__ std::int32_t first() const { return group.first + lane; }
  __device__ __forceinline__ std::int32_t stride() const { return Lanes; }
  /// Threads add in pairs, so that all of them get the same bits.
  __device__ __forceinline__ void join(physics::Balance<float>& balance) const
  {
    const std::uint32_t together = ((1u << Lanes) - 1) << (threadIdx.x & 31u & ~static_cast<std::uint32_t>(Lanes - 1));
    FRONTALIS_UNROLL
    for (int apart = Lanes / 2; apart > 0; apart /= 2)
      for (int i = 0; i < 3; ++i)
      {
        balance.momentum[i] += __shfl_xor_sync(together, balance.momentum[i], apart);
        for (int j = i; j < 3; ++j)
          balance.mass[i][j] += __shfl_xor_sync(together, balance.mass[i][j], apart);
        for (int j = 0; j < i; ++j)
          balance.mass[i][j] = balance.mass[j][i];
      }
    // All threads have read the master's motion before one of them changes it.
    __syncwarp(together);
  }
  __device__ __forceinline__ std::int32_t last() const { return group.last; }
  __device__ __forceinline__ float mass() const { return group.mass; }
  __device__ __forceinline__ bool fixed(int axis) const { return (group.fixed >> axis & 1u) != 0; }
  __device__ __forceinline__ bool held(std::int32_t tie) const { return tables.ties[tie].plane < 0; }
  __device__ __forceinline__ float ratio(std::int32_t tie) const { return tables.ties[tie].ratio; }
  __device__ __forceinline__ float mass(std::int32_t tie) const { return tables.ties[tie].mass; }
  __device__ __forceinline__ float offset(std::int32_t tie) const { return tables.ties[tie].offset; }

  __device__ __forceinline__ Motion motion_of(std::uint32_t node) const
  {
    const float4 moved = u[node];
    return { { moved.x, moved.y, moved.z }, { v[0][node], v[1][node], v[2][node] } };
  }
  __device__ __forceinline__ void set_motion_of(std::uint32_t node, const Motion& to) const
  {
    u[node] = make_float4(to.u.x, to.u.y, to.u.z, u[node].w);
    v[0][node] = to.v.x;
    v[1][node] = to.v.y;
    v[2][node] = to.v.z;
  }
  __device__ __forceinline__ Motion motion() const { return motion_of(group.master); }
  __device__ __forceinline__ Motion motion(std::int32_t tie) const { return motion_of(tables.ties[tie].node); }
  __device__ __forceinline__ void set_motion(const Motion& to) const
  {
    if (lane == 0)
      set_motion_of(group.master, to);
  }
  __device__ __forceinline__ void set_motion(std::int32_t tie, const Motion& to) const
  {
    set_motion_of(tables.ties[tie].node, to);
  }

  __device__ __forceinline__ Motion bone_at(std::int32_t bone, const float (&rest)[3]) const
  {
    if (bone < 0)
      return { { 0, 0, 0 }, { 0, 0, 0 } };
    const BoneMotion motion = bone_motion_at(g, step + 1, bone);
    const Place at{ rest[0], rest[1], rest[2] };
    return { motion.displacement_of(at), motion.velocity_at(at) };
  }
  __device__ __forceinline__ Motion bone_at_node(std::int32_t tie) const
  {
    return bone_at(tables.ties[tie].bone, tables.ties[tie].rest);
  }
  __device__ __forceinline__ Motion bone_at_master(std::int32_t tie) const
  {
    return bone_at(tables.ties[tie].bone, group.rest);
  }

  /// The plane of a node at the displacement `gone` relative to the surface. Where no samples are stored or the
  /// gradient is too short, the latest plane is kept.
  __device__ __forceinline__ physics::KeptLevel<float> kept_level(std::int32_t plane, const Place& gone) const
  {
    physics::KeptLevel<float> level = tables.planes[plane];
    if (level.covers(gone))
      return level;
    const AttachedPlace at = g.attached.places[plane];
    const physics::DistanceField& field = g.fields[at.surface];
    const Place offset{ at.offset[0], at.offset[1], at.offset[2] };
    physics::FieldValue<float> value{};
    if (field.radius > 0)
      value = physics::sphere_value(at.distance, offset, gone);
    else if (!physics::sample(field, { { at.cell[0], at.cell[1], at.cell[2] }, offset + gone }, value))
      return level;
    physics::renew_level(value, gone, level);
    tables.planes[plane] = g.attached.planes[plane] = level;
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
    const BoneMotion motion = bone_motion_at(g, step + 1, bone);
    const Place at{ rest[0], rest[1], rest[2] }, gone = motion.gone(at, moved);
    const physics::KeptLevel<float> level = kept_level(plane, gone);
    return { motion.turned(level.gradient), motion.velocity_at(at + gone), level.level_at(gone) };
  }
  __device__ __forceinline__ Level level_of_node(std::int32_t tie, const Place& moved) const
  {
    return level_at(tables.ties[tie].plane, tables.ties[tie].bone, tables.ties[tie].rest, moved);
  }
  __device__ __forceinline__ Level level_of_master(std::int32_t tie, const Place& moved) const
  {
    return level_at(tables.ties[tie].master_plane, tables.ties[tie].bone, group.rest, moved);
  }
};

/// Applies the constraints of one group after the update of a step. The `Lanes` threads of the group call it together.
/// u, v: as in MovedGroup.
template <int Lanes>
__device__ __forceinline__ void follow_master(const StepArguments& g, const GroupTables& tables, std::uint32_t index,
                                              int step, float4* u, float* const (&v)[3])
{
  const AttachedGroup group = tables.groups[index];
  MovedGroup<Lanes> moved{ g, tables, group, u, v, step, static_cast<int>(threadIdx.x) & (Lanes - 1) };
  physics::move_attached_group(moved, g.dt);
}

__device__ __forceinline__ GroupTables group_tables(const AttachedArguments& attached)
{
  return { attached.groups, attached.ties, attached.planes };
}

}  // namespace cuda
}  // namespace frontalis
