#pragma once

#include "cuda/kernels/attachment_arguments.hpp"
#include "cuda/kernels/bone_pose.cuh"
#include "cuda/kernels/kept_samples.cuh"
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

__device__ __forceinline__ physics::Vec3<float> place_of(const float (&p)[3]) { return { p[0], p[1], p[2] }; }
__device__ __forceinline__ physics::Vec3<float> displacement_of(const float4& u) { return { u.x, u.y, u.z }; }

/// Finds those planes of a sliding node and of its master anew that do not cover their displacements `u` (indexed by
/// device node). Where no samples are stored or the gradient is too short, the latest plane is kept. `when`: see
/// bone_motion_at().
static __device__ __noinline__ void renew_planes(const StepArguments& g, const AttachedGroup* group,
                                                 const AttachedTie* tie, physics::KeptLevel<float>* planes,
                                                 const float4* u, int when)
{
  physics::Vec3<float> gone[2] = { displacement_of(u[tie->node]), displacement_of(u[group->master]) };
  if (tie->bone >= 0)
  {
    const BoneMotion bone = bone_motion_at(g, when, tie->bone);
    gone[0] = bone.gone(place_of(tie->rest), gone[0]);
    gone[1] = bone.gone(place_of(group->rest), gone[1]);
  }
  for (int n = 0; n < 2; ++n)
  {
    const std::int32_t plane = n == 0 ? tie->plane : tie->master_plane;
    physics::KeptLevel<float> level = planes[plane];
    if (level.covers(gone[n]))
      continue;
    const AttachedPlace at = g.attached.places[plane];
    const physics::DistanceField& field = g.fields[at.surface];
    physics::FieldValue<float> value{};
    if (field.radius > 0)
      value = physics::sphere_value(at.distance, place_of(at.offset), gone[n]);
    else if (!physics::sample(field, { { at.cell[0], at.cell[1], at.cell[2] }, place_of(at.offset) + gone[n] }, value))
      continue;
    physics::renew_level(value, gone[n], level);
    planes[plane] = g.attached.planes[plane] = level;
  }
}

/// Renews the planes of a group that its nodes have left at the displacements `u`, each thread those of its ties.
template <int Lanes>
__device__ __forceinline__ void keep_planes(const StepArguments& g, const GroupTables& tables, std::uint32_t index,
                                            const float4* u, int when)
{
  const AttachedGroup* const group = tables.groups + index;
  for (std::int32_t t = group->first + static_cast<std::int32_t>(threadIdx.x & (Lanes - 1)); t < group->last;
       t += Lanes)
  {
    const AttachedTie* const tie = tables.ties + t;
    if (tie->plane < 0 || (tie->bone < 0 && tables.planes[tie->plane].covers(displacement_of(u[tie->node])) &&
                           tables.planes[tie->master_plane].covers(displacement_of(u[group->master]))))
      continue;
    aside(renew_planes)(g, group, tie, tables.planes, u, when);
  }
}

/// A group in the form that physics::move_attached_group() reads. Levels are functions of the displacement relative to
/// the surface, which single precision resolves to nanometres. `Bones`: whether some of its nodes or surfaces move with
/// bones.
template <int Lanes, bool Bones>
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

  __device__ __forceinline__ void bone_at(std::int32_t tie, Motion& node, Motion& master) const
  {
    const AttachedTie& of = tables.ties[tie];
    node = master = { { 0, 0, 0 }, { 0, 0, 0 } };
    if (!Bones || of.bone < 0)
      return;
    const BoneMotion bone = bone_motion_at(g, step + 1, of.bone);
    const Place at_node = place_of(of.rest), at_master = place_of(group.rest);
    node = { bone.displacement_of(at_node), bone.velocity_at(at_node) };
    master = { bone.displacement_of(at_master), bone.velocity_at(at_master) };
  }
  __device__ __forceinline__ void levels(std::int32_t tie, const Place& moved, const Place& master_moved, Level& own,
                                         Level& masters) const
  {
    const AttachedTie& of = tables.ties[tie];
    const physics::KeptLevel<float> plane = tables.planes[of.plane], masters_plane = tables.planes[of.master_plane];
    if (!Bones || of.bone < 0)
    {
      own = { plane.gradient, { 0, 0, 0 }, plane.level_at(moved) };
      masters = { masters_plane.gradient, { 0, 0, 0 }, masters_plane.level_at(master_moved) };
      return;
    }
    const BoneMotion bone = bone_motion_at(g, step + 1, of.bone);
    const Place rest = place_of(of.rest), master_rest = place_of(group.rest), gone = bone.gone(rest, moved),
                master_gone = bone.gone(master_rest, master_moved);
    own = { bone.turned(plane.gradient), bone.velocity_at(rest + gone), plane.level_at(gone) };
    masters = { bone.turned(masters_plane.gradient), bone.velocity_at(master_rest + master_gone),
                masters_plane.level_at(master_gone) };
  }
};

template <int Lanes>
static __device__ __noinline__ void follow_on_bones(const StepArguments& g, GroupTables tables, std::uint32_t index,
                                                    int step, float4* u, float* v0, float* v1, float* v2)
{
  const AttachedGroup group = tables.groups[index];
  float* const v[3] = { v0, v1, v2 };
  MovedGroup<Lanes, true> moved{ g, tables, group, u, v, step, static_cast<int>(threadIdx.x) & (Lanes - 1) };
  physics::move_attached_group(moved, g.dt);
}

/// Applies the constraints of one group after the update of a step, with planes that keep_planes() found. The `Lanes`
/// threads of the group call it together. u, v: as in MovedGroup.
template <int Lanes>
__device__ __forceinline__ void follow_master(const StepArguments& g, const GroupTables& tables, std::uint32_t index,
                                              int step, float4* u, float* const (&v)[3])
{
  const AttachedGroup group = tables.groups[index];
  // The code for bones is a call, because it would make the kernel spill registers in models without bones.
  if ((group.fixed & on_bones) != 0)
  {
    aside(follow_on_bones<Lanes>)(g, tables, index, step, u, v[0], v[1], v[2]);
    return;
  }
  MovedGroup<Lanes, false> moved{ g, tables, group, u, v, step, static_cast<int>(threadIdx.x) & (Lanes - 1) };
  physics::move_attached_group(moved, g.dt);
}

__device__ __forceinline__ GroupTables group_tables(const AttachedArguments& attached)
{
  return { attached.groups, attached.ties, attached.planes };
}

}  // namespace cuda
}  // namespace frontalis
