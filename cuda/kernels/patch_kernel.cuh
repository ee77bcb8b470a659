#pragma once

#include "cuda/kernels/contact_points.cuh"
#include "cuda/kernels/element_stress.cuh"
#include "cuda/kernels/node_tasks.cuh"

#include <utility>

namespace frontalis
{
namespace cuda
{

// A block of threads keeps its patch, including the halo, in shared memory for all steps of a launch. In a step each
// thread computes a voxel and writes the forces on its corners to shared memory, then updates a node. Between steps
// only border nodes are exchanged with other blocks. Displacement and step number are written as one 16-byte word, so
// that a reader waits for exactly the data it needs, without barriers between blocks or fences. Neighbouring patches
// read each other, so a writer is at most one step ahead of its readers, and two buffers suffice.

/// Layout of the shared memory of a block; see patch_bytes().
struct PatchMemory
{
  float4* place;        // displacements of halo nodes, then of own nodes with their inverse mass
  float* v[3];          // velocities of own nodes
  float* force;         // [corner][component][voxel], then stiffness; the last column belongs to no voxel and stays 0
  std::uint32_t width;  // length of a row of `force`
  float4* push;         // of each point of contact: force on it and its coordinates
  std::uint32_t*
      least;  // two entries: see put_pushes(). While a slow thread reads that of a patch, the next uses another.
};

template <Effects With>
__device__ __forceinline__ PatchMemory patch_memory(const StepLaunch& launch)
{
  extern __shared__ float4 all[];
  float4* const push = all + launch.most_halo + launch.most_nodes;
  float4* const least = push + (has<With, Effects::contact> ? 2 * launch.most_points : 0);
  float* const v = reinterpret_cast<float*>(least + (has<With, Effects::contact> ? 1 : 0));
  return { all,
           { v, v + launch.most_nodes, v + 2 * launch.most_nodes },
           v + 3 * launch.most_nodes,
           launch.most_voxels + 1,
           push,
           reinterpret_cast<std::uint32_t*>(least) };
}

/// Step number, stored in place of the inverse mass. Its highest bit is set, which no inverse mass has.
__device__ __forceinline__ std::uint32_t mark(const StepArguments& g, std::int32_t step)
{
  return 0x80000000u | (g.steps_before + static_cast<std::uint32_t>(step - g.step_begin));
}

__device__ __forceinline__ void send(float4* to, const float* u, std::uint32_t mark)
{
  asm volatile(
      "{ .reg .b64 low, high; .reg .b128 all; mov.b64 low, {%1, %2}; mov.b64 high, {%3, %4};"
      " mov.b128 all, {low, high}; st.relaxed.gpu.global.b128 [%0], all; }" ::"l"(to),
      "r"(__float_as_uint(u[0])), "r"(__float_as_uint(u[1])), "r"(__float_as_uint(u[2])), "r"(mark)
      : "memory");
}

__device__ __forceinline__ float4 receive(const float4* from, std::uint32_t mark)
{
  std::uint32_t word[4];
  do
    asm volatile(
        "{ .reg .b64 low, high; .reg .b128 all; ld.relaxed.gpu.global.b128 all, [%4];"
        " mov.b128 {low, high}, all; mov.b64 {%0, %1}, low; mov.b64 {%2, %3}, high; }"
        : "=r"(word[0]), "=r"(word[1]), "=r"(word[2]), "=r"(word[3])
        : "l"(from)
        : "memory");
  while (word[3] != mark);
  return make_float4(__uint_as_float(word[0]), __uint_as_float(word[1]), __uint_as_float(word[2]), 0);
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

/// Data of a voxel apart from the displacements of its corners.
struct VoxelFetch
{
  uint4 corner;
  ElementPlace place;
};

template <Effects With>
__device__ __forceinline__ VoxelFetch fetch_voxel(const StepArguments& g, std::uint32_t index)
{
  VoxelFetch voxel{};
  voxel.corner = __ldg(g.patch_corners + index);
  if (has<With, Effects::fibres>)
  {
    const uint2 properties = __ldg(g.patch_properties + index);
    voxel.place.palette = properties.x;
    fetch_fibre(g, properties.y, voxel.place);
  }
  else
    voxel.place.palette = __ldg(&g.patch_properties[index].x);
  if (has<With, Effects::viscosity>)
    voxel.place.viscous = __ldg(g.viscous_words + index);
  return voxel;
}

template <Effects With>
__device__ __forceinline__ void put_forces(const StepArguments& g, const VoxelFetch& voxel,
                                           const Activations& activation, float relaxes, bool with_bound,
                                           const PatchMemory& memory, std::uint32_t column)
{
  std::uint32_t corner[8];
  split(voxel.corner, corner);
  float mode[3][8];
#pragma unroll
  for (int b = 0; b < 8; ++b)
  {
    const float4 u = memory.place[corner[b]];
    mode[0][b] = u.x;
    mode[1][b] = u.y;
    mode[2][b] = u.z;
  }
#pragma unroll
  for (int c = 0; c < 3; ++c)
    physics::walsh_hadamard(mode[c]);
  float stiffness = 0;
  element_forces<With>(g, voxel.place, activation, relaxes, mode, with_bound, stiffness);
  if (with_bound)
    memory.force[24 * memory.width + column] = stiffness;
#pragma unroll
  for (int c = 0; c < 3; ++c)
  {
    physics::walsh_hadamard_transposed(mode[c]);
#pragma unroll
    for (int b = 0; b < 8; ++b)
      memory.force[(3 * b + c) * memory.width + column] = mode[c][b];
  }
}

/// What a thread knows of its patch's contact in a step. Points are skipped until nodes and bodies together have moved
/// as far as the nearest point was away when they were looked at. At the start of a launch they are looked at. The
/// bodies' way since the start of the plan may become `until`, less that of the nodes.
struct ContactWatch
{
  float way;      ///< by which nodes may have moved since [m]; not positive: points are looked at
  float4 node;    ///< the first of its watched nodes
  bool moved_on;  ///< one of its nodes has moved farther
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

/// Compares the displacements of watched nodes.
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
    // also where the motion has diverged
    if (!(x * x + y * y + z * z < watch.way * watch.way))
      watch.moved_on = true;
  }
}

/// Finds the forces on the patch's points of contact. Threads take points from the last thread on, because the first
/// ones have the more voxels. Returns whether one of this thread's points is pushed. Lowers `least`, bits of the way by
/// which all points may move before they must be looked at again.
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
  // a point that touches may not move at all
  return free_way == 0;
}

/// Adds the forces on points to those on the corners of their voxels, in the order of the points. Each thread has a
/// corner of a voxel.
__device__ __forceinline__ void add_pushes(const StepArguments& g, const PatchContact& contact,
                                           const PatchMemory& memory)
{
  for (std::uint32_t i = threadIdx.x; i < 8 * contact.voxels; i += blockDim.x)
  {
    const ContactVoxel voxel = g.contact.voxels[contact.voxel_begin + i / 8];
    const std::uint32_t b = i % 8;
    physics::Vec3<float> sum{ 0, 0, 0 };
    for (std::uint32_t p = voxel.first; p < voxel.end; ++p)
    {
      const float4 push = memory.push[2 * p], more = memory.push[2 * p + 1];
      add_part(sum, corner_weight(b, push.w, more.x, more.y), push);
    }
    float* const to = memory.force + 3 * b * memory.width + voxel.column;
    // internal forces have the opposite sign
    to[0] -= sum.x;
    to[memory.width] -= sum.y;
    to[2 * memory.width] -= sum.z;
  }
}

/// Ends the computation of voxels with a barrier; with contact, adds its forces to theirs. `until`: see
/// ContactWatch.
template <Effects With>
__device__ __forceinline__ void end_voxels(const StepArguments& g, const PatchContact& contact,
                                           const ContactWatch& watch, const PatchMemory& memory, int step,
                                           std::uint32_t* least, float& until)
{
  if (!has<With, Effects::contact>)
    return __syncthreads();
  // all threads have the same answer
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

/// Force on a node: the sum over its voxels, in the order of their corner 0 .. 7 that the node is.
__device__ __forceinline__ void sum_forces(const PatchMemory& memory, const uint4& voxels, float (&force)[3])
{
  std::uint32_t column[8];
  split(voxels, column);
#pragma unroll
  for (int c = 0; c < 3; ++c)
  {
    force[c] = 0;
#pragma unroll
    for (int b = 0; b < 8; ++b)
      force[c] += memory.force[(3 * b + c) * memory.width + column[b]];
  }
}

/// Bits of the bound of the squared highest frequency at a node.
__device__ __forceinline__ std::uint32_t bound_of_node(const StepArguments& g, const PatchMemory& memory,
                                                       std::uint32_t node, float inverse_mass)
{
  std::uint32_t column[8];
  split(__ldg(g.node_voxels + node), column);
  float stiffness = 0;
#pragma unroll
  for (int b = 0; b < 8; ++b)
    stiffness += memory.force[24 * memory.width + column[b]];
  return frequency_bits_of(g, node, inverse_mass, stiffness);
}

/// Updates a node. `own`: its number in the block. `last`: in the last step, which writes all to global memory.
template <Effects With>
__device__ __forceinline__ void step_patch_node(const StepArguments& g, const PatchMemory& memory, std::uint32_t node,
                                                std::uint32_t own, const StepLaunch& launch, bool on_border, bool last,
                                                float4* next, int step)
{
  const std::int32_t task = __ldg(g.patch_tasks + node);
  SlidingFetch fetched;
  if (has<With, Effects::sliding> && task >= 0)
    fetch_sliding<With>(g, task, fetched);
  float force[3];
  sum_forces(memory, __ldg(g.node_voxels + node), force);
  if (g.forces_only)
  {
    next[node] = make_float4(force[0], force[1], force[2], 0);
    return;
  }
  float4& place = memory.place[launch.most_halo + own];
  const NodeFetch fetch{ place, { memory.v[0][own], memory.v[1][own], memory.v[2][own] } };
  NodeState n{ { place.x, place.y, place.z }, { fetch.v[0], fetch.v[1], fetch.v[2] } };
  if (task != patch_task::still)
  {
    n = updated(g, node, fetch, force);
    if (has<With, Effects::sliding> && task >= 0)
      slide<With>(g, task, { fetch.own, node, step }, fetched, n);
    else if (has<With, Effects::tasks> && task != patch_task::none)
    {
      // a copy, so that the state of nodes without tasks stays in registers
      NodeState held = n;
      apply_task<part<With, of_nodes>>(g, g.tasks[patch_task::other - task], fetch.own, step, held);
      n = held;
    }
#pragma unroll
    for (int i = 0; i < 3; ++i)
      memory.v[i][own] = n.v[i];
    place = make_float4(n.u[0], n.u[1], n.u[2], fetch.own.w);
  }
  if (last)
  {
    next[node] = make_float4(n.u[0], n.u[1], n.u[2], fetch.own.w);
#pragma unroll
    for (int i = 0; i < 3; ++i)
      g.v[i][node] = n.v[i];
  }
  else if (on_border)
    send(next + node, n.u, mark(g, step + 1));
}

// Set: as in step_kernel.cuh
template <int Set>
__global__ void __launch_bounds__(most_patch_threads, 1)
    patch_kernel(const __grid_constant__ StepArguments g, const __grid_constant__ StepLaunch launch)
{
  constexpr Effects With = static_cast<Effects>(Set);
  __shared__ float2 activations[has<With, Effects::fibres> ? most_muscles : 1];
  constexpr Effects plain = plain_part<With>;
  const PatchMemory memory = patch_memory<With>(launch);
  const std::uint32_t threads = blockDim.x;
  if (has<With, Effects::fibres>)
    load_activations(g, activations);
  float until[most_turns];  // with contact: see ContactWatch
  std::uint32_t round = 0;
  std::uint32_t filled = 0;
  for (std::uint32_t p = blockIdx.x; p < g.patch_count; p += gridDim.x)
  {
    const Patch patch = g.patches[p];
    for (std::uint32_t n = threadIdx.x; n < patch.nodes; n += threads)
    {
      const std::uint32_t node = patch.first_node + n;
      memory.place[launch.most_halo + filled + n] = g.u[g.first][node];
#pragma unroll
      for (int i = 0; i < 3; ++i)
        memory.v[i][filled + n] = g.v[i][node];
    }
    filled += patch.nodes;
  }
  if (threadIdx.x < 25)
    memory.force[threadIdx.x * memory.width + launch.most_voxels] = 0;
  for (std::int32_t step = g.step_begin; step < g.step_end; ++step)
  {
    const int present = (g.first + step - g.step_begin) & 1;
    const float4* const u = g.u[present];
    const bool with_bound = g.frequency_bound != nullptr && (g.bound_every_step || step + 1 == g.steps);
    std::uint32_t frequency_bits = 0;
    filled = 0;
    const Activations activation = activations_at(g, step, activations);
    const float relaxes = has<With, Effects::viscosity> && g.relaxation != nullptr ? __ldg(g.relaxation + step) : 0.0f;
    int turn = 0;
    for (std::uint32_t p = blockIdx.x; p < g.patch_count; p += gridDim.x, ++turn)
    {
      const Patch patch = g.patches[p];
      PatchContact contact{};
      ContactWatch watch{};
      if (has<With, Effects::contact>)
      {
        contact = g.contact.patches[p];
        watch = fetch_watch(g, contact, until[turn], step);
        round ^= 1;
        if (threadIdx.x == 0)
          memory.least[round] = 0xffffffffu;
      }
      VoxelFetch voxel{};
      // Voxels with fibres or viscosity come first. Warps in which no voxel has either skip both.
      const auto is_plain = [&](std::uint32_t v) { return With == plain || (v & ~31u) >= patch.special; };
      const auto fetch = [&](std::uint32_t v) {
        return is_plain(v) ? fetch_voxel<plain>(g, patch.voxel_begin + v) : fetch_voxel<With>(g, patch.voxel_begin + v);
      };
      if (threadIdx.x < patch.voxels)
        voxel = fetch(threadIdx.x);
      for (std::uint32_t h = threadIdx.x; h < patch.halo; h += threads)
      {
        const float4* const from = u + __ldg(g.halo + patch.halo_begin + h);
        memory.place[h] = step == g.step_begin ? *from : receive(from, mark(g, step));
      }
      __syncthreads();
      if (has<With, Effects::contact>)
        look_at_watched(g, contact, memory, watch);
      for (std::uint32_t v = threadIdx.x; v < patch.voxels; v += threads)
      {
        if (v != threadIdx.x)
          voxel = fetch(v);
        if (is_plain(v))
          put_forces<plain>(g, voxel, activation, 0, with_bound, memory, v);
        else
          put_forces<With>(g, voxel, activation, relaxes, with_bound, memory, v);
      }
      end_voxels<With>(g, contact, watch, memory, step, memory.least + round, until[turn]);
      const bool last = step + 1 == g.step_end;
      for (std::uint32_t n = threadIdx.x; n < patch.nodes; n += threads)
        step_patch_node<With>(g, memory, patch.first_node + n, filled + n, launch, n < patch.border, last,
                              g.u[1 - present], step);
      if (with_bound)
        for (std::uint32_t n = threadIdx.x; n < patch.nodes; n += threads)
          if (__ldg(g.patch_tasks + patch.first_node + n) != patch_task::still)
            frequency_bits = max(frequency_bits, bound_of_node(g, memory, patch.first_node + n,
                                                               memory.place[launch.most_halo + filled + n].w));
      filled += patch.nodes;
    }
    if (with_bound)
    {
      const std::uint32_t largest = largest_of_warp(frequency_bits);
      if ((threadIdx.x & 31) == 0)
        atomicMax(g.frequency_bound, largest);
    }
  }
}

/// The patch kernel for a set of effects. `Nodes`: the effects of nodes in it.
template <Effects Nodes, int... Voxels>
const void* patch_kernel_of(Effects effects, std::integer_sequence<int, Voxels...>)
{
  const void* const kernels[] = { reinterpret_cast<const void*>(patch_kernel<Voxels | int(Nodes)>)... };
  return kernels[static_cast<int>(voxel_part(effects))];
}
template <Effects Nodes>
const void* patch_kernel_of(Effects effects)
{
  return patch_kernel_of<Nodes>(effects, std::make_integer_sequence<int, voxel_sets>());
}

/// Kernels are in separate translation units, because nvcc gives every kernel that calls through a table the registers
/// of the largest function in all tables of the unit.
const void* sliding_patch_kernel(Effects effects);
const void* friction_patch_kernel(Effects effects);
const void* contact_patch_kernel(Effects effects);

}  // namespace cuda
}  // namespace frontalis
