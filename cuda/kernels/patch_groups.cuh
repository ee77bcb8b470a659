#pragma once

#include "cuda/kernels/attached_group.cuh"
#include "cuda/kernels/patch_contact.cuh"
#include "cuda/kernels/patch_exchange.cuh"

namespace frontalis
{
namespace cuda
{

// Groups of attached nodes in patches. A patch has all nodes of its groups.

/// The groups of a patch in a step.
struct GroupStep
{
  GroupTables tables;        ///< in shared memory if there is room, else in global memory
  std::uint32_t begin, end;  ///< groups of the patch
  std::uint32_t words;       ///< number of words of the tables in shared memory
};

/// The groups of patch p. `kept`: number of words of shared memory that hold tables of the block's earlier patches.
__device__ __forceinline__ GroupStep fetch_groups(const StepArguments& g, const StepLaunch& launch,
                                                  const PatchMemory& memory, std::uint32_t p, std::uint32_t kept)
{
  if (g.attached.patches == nullptr)
    return {};
  const PatchGroups first = g.attached.patches[p], next = g.attached.patches[p + 1];
  GroupStep step{ group_tables(g.attached), first.group, next.group, 0 };
  if (launch.room.group_words == 0)
    return step;
  step.words = group_words(first, next);
  const auto groups = reinterpret_cast<AttachedGroup*>(memory.groups + kept);
  const auto ties = reinterpret_cast<AttachedTie*>(groups + (next.group - first.group));
  const auto planes = reinterpret_cast<physics::KeptLevel<float>*>(ties + (next.tie - first.tie));
  step.tables = { groups - first.group, ties - first.tie, planes - first.plane };
  return step;
}

template <class Entry>
__device__ __forceinline__ uint4* copy_words(const Entry* begin, const Entry* end, uint4* to)
{
  const uint4* const from = reinterpret_cast<const uint4*>(begin);
  const std::ptrdiff_t count = reinterpret_cast<const uint4*>(end) - from;
  for (std::ptrdiff_t w = threadIdx.x; w < count; w += blockDim.x)
    to[w] = from[w];
  return to + count;
}

/// Copies the tables of patch p to shared memory, at the start of a launch. Returns their number of words. `kept`: see
/// fetch_groups().
__device__ __forceinline__ std::uint32_t keep_groups(const StepArguments& g, const StepLaunch& launch,
                                                     const PatchMemory& memory, std::uint32_t p, std::uint32_t kept)
{
  const std::uint32_t words = fetch_groups(g, launch, memory, p, kept).words;
  if (words == 0)
    return 0;
  const PatchGroups first = g.attached.patches[p], next = g.attached.patches[p + 1];
  uint4* to = memory.groups + kept;
  to = copy_words(g.attached.groups + first.group, g.attached.groups + next.group, to);
  to = copy_words(g.attached.ties + first.tie, g.attached.ties + next.tie, to);
  copy_words(g.attached.planes + first.plane, g.attached.planes + next.plane, to);
  return words;
}

__device__ __forceinline__ bool in_group(const StepArguments& g, std::uint32_t node)
{
  return g.attached.grouped != nullptr && (__ldg(g.attached.grouped + node / 32) >> (node & 31u) & 1u) != 0;
}

/// Moves the groups of a patch after the update of its nodes, and makes their nodes known. `filled`: number of nodes in
/// earlier patches of the block. A barrier must follow before displacements are read.
__device__ __forceinline__ void move_groups(const StepArguments& g, const StepLaunch& launch, const PatchMemory& memory,
                                            const Patch& patch, const GroupStep& groups, std::uint32_t filled,
                                            bool last, float4* next, int step)
{
  if (groups.begin == groups.end)
    return;
  // Groups know nodes by their numbers on the device.
  float4* const u = memory.place + launch.most_halo + filled - patch.first_node;
  float* const v[3] = { memory.v[0] + filled - patch.first_node, memory.v[1] + filled - patch.first_node,
                        memory.v[2] + filled - patch.first_node };
  const auto make_known = [&](std::uint32_t node)
  {
    const float4 at = u[node];
    const float moved[3] = { at.x, at.y, at.z }, velocity[3] = { v[0][node], v[1][node], v[2][node] };
    publish(g, node, moved, velocity, at.w, node - patch.first_node < patch.border, last, next, step);
  };
  const std::int32_t lane = static_cast<std::int32_t>(threadIdx.x) & (group_lanes - 1);
  __syncthreads();
  for (std::uint32_t index = groups.begin + threadIdx.x / group_lanes; index < groups.end;
       index += blockDim.x / group_lanes)
  {
    keep_planes<group_lanes>(g, groups.tables, index, u, step + 1);
    follow_master<group_lanes>(g, groups.tables, index, step, u, v);
    const AttachedGroup& group = groups.tables.groups[index];
    if (lane == 0)
      make_known(group.master);
    for (std::int32_t tie = group.first + lane; tie < group.last; tie += group_lanes)
      make_known(groups.tables.ties[tie].node);
  }
}

}  // namespace cuda
}  // namespace frontalis
