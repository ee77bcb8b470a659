#pragma once

#include "cuda/kernels/contact_points.cuh"

namespace frontalis
{
namespace cuda
{

// Contact with bodies in patches. It uses part of their shared memory.

/// Layout of the shared memory of a block; see patch_bytes().
struct PatchMemory
{
  float4* place;        // displacements of halo nodes, then of own nodes with their inverse mass
  float* v[3];          // velocities of own nodes
  float* force;         // [corner][component][voxel], then stiffness; the last column belongs to no voxel and stays 0
  std::uint32_t width;  // length of a row of `force`
  float4* push;         // per point of contact: force on it, and its coordinates
  float4* shell;        // displacements of vertices of shells, and forces of triangles
  uint4* tables;        // see PatchShell
  float4* touch;        // vertices that may touch other tissue; see patch_touch.cuh
  uint4* groups;        // see GroupStep
  // smallest distance that put_pushes() found, as bits; patches use two entries in turn, because slow threads may still
  // read the entry of the previous patch
  std::uint32_t* least;
};

template <Effects With>
__device__ __forceinline__ PatchMemory patch_memory(const StepLaunch& launch)
{
  extern __shared__ float4 all[];
  float4* const push = all + launch.most_halo + launch.most_nodes;
  float4* const shell = push + (has<With, Effects::contact> ? 2 * launch.room.contact_points : 0);
  float4* const tables = shell + (has<With, Effects::shell> ? launch.room.shell_words : 0);
  float4* const touch = tables + (has<With, Effects::shell> ? launch.room.table_words : 0);
  float4* const groups = touch + (has<With, Effects::touch> ? touch_room * launch.room.touch_vertices : 0);
  float4* const least = groups + (has<With, Effects::groups> ? launch.room.group_words : 0);
  float* const v = reinterpret_cast<float*>(least + (has<With, Effects::contact> ? 1 : 0));
  return { all,
           { v, v + launch.most_nodes, v + 2 * launch.most_nodes },
           v + 3 * launch.most_nodes,
           launch.most_voxels + 1,
           push,
           shell,
           reinterpret_cast<uint4*>(tables),
           touch,
           reinterpret_cast<uint4*>(groups),
           reinterpret_cast<std::uint32_t*>(least) };
}

__device__ __forceinline__ void split(const uint4& words, std::uint32_t (&out)[8])
{
  const std::uint32_t word[4] = { words.x, words.y, words.z, words.w };
#pragma unroll
  for (int i = 0; i < 4; ++i)
  {
    out[2 * i] = word[i] & 0xffffu;
    out[2 * i + 1] = word[i] >> 16;
  }
}

/// What a thread knows about its patch's contact in a step. All points are evaluated at the start of a launch. They are
/// evaluated again when the motion of the bodies since the start of the plan (ContactArguments::ways) plus that of the
/// points since the latest evaluation could reach `until`, which is found from the smallest gap at the latest
/// evaluation.
struct ContactWatch
{
  float way;    ///< distance by which nodes may have moved since the evaluation [m]; not positive: evaluate the points
  float4 node;  ///< the first of the thread's watched nodes
  bool moved_on;  ///< whether one of the thread's nodes has moved farther
};

__device__ __forceinline__ ContactWatch fetch_watch(const StepArguments& g, const PatchContact& contact, float until,
                                                    int step)
{
  ContactWatch watch{ 0, {}, false };
  if (contact.points == 0 || step == g.step_begin)
    return watch;
  watch.way = (until - g.contact.ways[step]) * g.contact.inverse_spread;
  if (threadIdx.x < contact.nodes)
    watch.node = g.contact.watched[contact.node_begin + threadIdx.x];
  return watch;
}

/// Compares the displacements of the watched nodes with those at the latest evaluation.
__device__ __forceinline__ void look_at_watched(const StepArguments& g, const PatchContact& contact,
                                                const PatchMemory& memory, ContactWatch& watch)
{
  if (!(watch.way > 0))
    return;
  for (std::uint32_t i = threadIdx.x; i < contact.nodes; i += blockDim.x)
  {
    const float4 then = i == threadIdx.x ? watch.node : g.contact.watched[contact.node_begin + i];
    const float4 now = memory.place[__float_as_uint(then.w)];
    const float x = now.x - then.x, y = now.y - then.y, z = now.z - then.z;
    // The negated condition is also true for NaN, after the motion has diverged.
    if (!(x * x + y * y + z * z < watch.way * watch.way))
      watch.moved_on = true;
  }
}

/// Finds the forces on the patch's points of contact. Points are given to threads in reverse order, because the first
/// threads have more voxels. Returns whether one of this thread's points is pushed. Lowers `least`, the bits of the
/// distance by which all points may move before they must be evaluated again.
__device__ __forceinline__ bool put_pushes(const StepArguments& g, const PatchContact& contact,
                                           const PatchMemory& memory, int step, std::uint32_t* least)
{
  constexpr float endless = 1e30f;
  float free_way = endless;
  for (std::uint32_t p = blockDim.x - 1 - threadIdx.x; p < contact.points; p += blockDim.x)
  {
    const std::uint32_t index = contact.point_begin + p;
    const ContactPoint point = g.contact.points[index];
    const auto& at = point.coordinates;
    std::uint32_t corner[8];
    split(__ldg(g.contact.corners + index), corner);
    float weight[8];
    physics::trilinear_weights(at[0], at[1], at[2], weight);
    physics::Vec3<float> moved{ 0, 0, 0 };
#pragma unroll
    for (int b = 0; b < 8; ++b)
      add_part(moved, weight[b], memory.place[corner[b]]);
    const Push push = find_push(g, point, { index, step, step + 1 == g.step_end, moved });
    free_way = fminf(free_way, push.free_way);
    memory.push[2 * p] = make_float4(push.force.x, push.force.y, push.force.z, at[0]);
    memory.push[2 * p + 1] = make_float4(at[1], at[2], 0, 0);
  }
  for (std::uint32_t i = threadIdx.x; i < contact.nodes; i += blockDim.x)
  {
    float4& watched = g.contact.watched[contact.node_begin + i];
    const float4 now = memory.place[__float_as_uint(watched.w)];
    watched = make_float4(now.x, now.y, now.z, watched.w);
  }
  if (free_way < endless)
    atomicMin(least, __float_as_uint(free_way));
  // A point that touches must be evaluated in every step.
  return free_way == 0;
}

/// Adds the forces on points to those on the corners of their voxels, in the order of the points. Each thread processes
/// a corner of a voxel.
__device__ __forceinline__ void add_pushes(const StepArguments& g, const PatchContact& contact,
                                           const PatchMemory& memory)
{
  for (std::uint32_t i = threadIdx.x; i < 8 * contact.voxels; i += blockDim.x)
  {
    const BoundVoxel voxel = g.contact.voxels[contact.voxel_begin + i / 8];
    const std::uint32_t b = i % 8;
    physics::Vec3<float> sum{ 0, 0, 0 };
    for (std::uint32_t p = voxel.first; p < voxel.end; ++p)
    {
      const float4 push = memory.push[2 * p], more = memory.push[2 * p + 1];
      add_part(sum, corner_weight(b, push.w, more.x, more.y), push);
    }
    float* const to = memory.force + 3 * b * memory.width + voxel.column;
    // Internal forces have the opposite sign.
    to[0] -= sum.x;
    to[memory.width] -= sum.y;
    to[2 * memory.width] -= sum.z;
  }
}

/// Ends the computation of voxels with a barrier. With contact, also adds its forces to those of the voxels. `until`:
/// see ContactWatch.
template <Effects With>
__device__ __forceinline__ void end_voxels(const StepArguments& g, const PatchContact& contact,
                                           const ContactWatch& watch, const PatchMemory& memory, int step,
                                           std::uint32_t* least, float& until)
{
  if (!has<With, Effects::contact>)
    return __syncthreads();
  // The condition has the same value in all threads, so that all reach the same barrier.
  if (contact.points == 0 || (g.forces_only && !g.contact.spring))
    return __syncthreads();
  if (watch.way > 0 && __syncthreads_or(watch.moved_on) == 0)
    return;
  const bool any = __syncthreads_or(put_pushes(g, contact, memory, step, least)) != 0;
  until = any ? 0 : __uint_as_float(*least) + g.contact.ways[step];
  if (!any)
    return;
  add_pushes(g, contact, memory);
  __syncthreads();
}

}  // namespace cuda
}  // namespace frontalis
