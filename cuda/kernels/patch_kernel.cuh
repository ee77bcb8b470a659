#pragma once

#include "cuda/kernels/cut_voxel.cuh"
#include "cuda/kernels/element_stress.cuh"
#include "cuda/kernels/node_tasks.cuh"
#include "cuda/kernels/patch_groups.cuh"
#include "cuda/kernels/patch_shell.cuh"
#include "cuda/kernels/patch_touch.cuh"

#include <utility>

namespace frontalis
{
namespace cuda
{

// A block of threads keeps its patch, including the halo, in shared memory for all steps of a launch. In a step each
// thread computes a voxel, writes the forces on its corners to shared memory, and then updates a node. Between steps,
// blocks exchange only border nodes (patch_exchange.cuh).

/// Data of a voxel without the displacements of its corners.
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
  physics::TissueCentre<float> centre{};
  if constexpr (has<With, Effects::cut>)
  {
    // Models that have groups but no cut voxels use the same kernels.
    if (g.centres != nullptr)
    {
      centre = tissue_centre(g, voxel.place.palette);
#pragma unroll
      for (int c = 0; c < 3; ++c)
        physics::to_tissue_centre(centre, mode[c]);
    }
  }
  element_forces(element_voxel<With>(g, voxel.place, activation, relaxes), mode, with_bound, stiffness);
  if (with_bound)
    memory.force[24 * memory.width + column] = stiffness;
#pragma unroll
  for (int c = 0; c < 3; ++c)
  {
    if constexpr (has<With, Effects::cut>)
      if (g.centres != nullptr)
        physics::from_tissue_centre(centre, mode[c]);
    physics::walsh_hadamard_transposed(mode[c]);
#pragma unroll
    for (int b = 0; b < 8; ++b)
      memory.force[(3 * b + c) * memory.width + column] = mode[c][b];
  }
}

/// Force on a node: the sum over the voxels of which the node is corner 0, 1, ... 7, in this order.
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
template <Effects With>
__device__ __forceinline__ std::uint32_t bound_of_node(const StepArguments& g, const PatchMemory& memory,
                                                       const Patch& patch, std::uint32_t node, float inverse_mass)
{
  std::uint32_t column[8];
  split(__ldg(g.node_voxels + node), column);
  float stiffness = 0;
#pragma unroll
  for (int b = 0; b < 8; ++b)
  {
    float factor = 1;
    if constexpr (has<With, Effects::cut>)
      if (g.corner_stiffness != nullptr && column[b] < patch.voxels)
        factor = corner_factors(g, __ldg(&g.patch_properties[patch.voxel_begin + column[b]].x)).at[b];
    stiffness += factor * memory.force[24 * memory.width + column[b]];
  }
  return frequency_bits_of(g, node, inverse_mass, stiffness);
}

/// Updates a node, and makes it known if it is in no group. `own`: index of the node in the block. `last`: as in
/// publish().
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
    else if (has<With, Effects::contact> && task < patch_task::none && patch_task::kind_of(task) != patch_task::other)
    {
      // Models with contact have many such nodes, and a call through the table would take longer than their step.
      const NodeStep at{ fetch.own, node, step };
      if (patch_task::kind_of(task) == patch_task::glides)
        glide_here<part<With, of_nodes>>(g, patch_task::index_of(task), at, n);
      else
        move_with_bone(g, patch_task::index_of(task), at, n);
    }
    else if (has<With, Effects::tasks> && task != patch_task::none)
    {
      // The copy lets the state of nodes without tasks stay in registers.
      NodeState held = n;
      apply_patch_task<part<With, of_nodes>>(g, task, { fetch.own, node, step }, held);
      n = held;
    }
#pragma unroll
    for (int i = 0; i < 3; ++i)
      memory.v[i][own] = n.v[i];
    place = make_float4(n.u[0], n.u[1], n.u[2], fetch.own.w);
  }
  if (!has<With, Effects::groups> || !in_group(g, node))
    publish(g, node, n.u, n.v, fetch.own.w, on_border, last, next, step);
}

// Set: effects, as an int for the reason given in step_kernel.cu.
template <int Set>
__global__ void __launch_bounds__(most_patch_threads, 1)
    patch_kernel(const __grid_constant__ StepArguments g, const __grid_constant__ StepLaunch launch)
{
  constexpr Effects With = static_cast<Effects>(Set);
  __shared__ float2 activations[has<With, Effects::fibres> ? most_muscles : 1];
  constexpr Effects plain = plain_part<With>, lawless = lawless_part<With>;
  const PatchMemory memory = patch_memory<With>(launch);
  const std::uint32_t threads = blockDim.x;
  if (has<With, Effects::fibres>)
    load_activations(g, activations);
  float until[most_turns];  // per patch of the block: see ContactWatch [m]
  std::uint32_t round = 0;
  std::uint32_t filled = 0, kept = 0, kept_groups = 0;
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
    if (has<With, Effects::shell>)
      kept += keep_shell(g, launch, memory, p, kept);
    if (has<With, Effects::groups>)
      kept_groups += keep_groups(g, launch, memory, p, kept_groups);
  }
  if (threadIdx.x < 25)
    memory.force[threadIdx.x * memory.width + launch.most_voxels] = 0;
  if (has<With, Effects::touch>)
    clear_touch(launch, memory);
  for (std::int32_t step = g.step_begin; step < g.step_end; ++step)
  {
    const int present = (g.first + step - g.step_begin) & 1;
    const float4* const u = g.u[present];
    const bool with_bound = g.frequency_bound != nullptr && (g.bound_every_step || step + 1 == g.steps);
    std::uint32_t frequency_bits = 0;
    filled = kept = kept_groups = 0;
    const Activations activation = activations_at(g, step, activations);
    const float relaxes = has<With, Effects::viscosity> && g.relaxation != nullptr ? __ldg(g.relaxation + step) : 0.0f;
    int turn = 0;
    for (std::uint32_t p = blockIdx.x; p < g.patch_count; p += gridDim.x, ++turn)
    {
      const Patch patch = g.patches[p];
      PatchContact contact{};
      ContactWatch watch{};
      ShellStep shell{};
      TouchStep touch{};
      if (has<With, Effects::touch>)
        touch = fetch_touch(g, launch, p, step);
      if (has<With, Effects::contact>)
      {
        if (!has<With, Effects::shell> || g.contact.patches != nullptr)
          contact = g.contact.patches[p];
        watch = fetch_watch(g, contact, until[turn], step);
        round ^= 1;
        if (threadIdx.x == 0)
          memory.least[round] = 0xffffffffu;
      }
      if (has<With, Effects::shell>)
        shell = fetch_shell(g, launch, memory, p, kept);
      VoxelFetch voxel{};
      // Voxels with laws, fibres or viscosity come first, so that warps without such voxels skip the code for them.
      const bool general = g.stabilisation != nullptr || g.selective_reduced;
      const auto is_plain = [&](std::uint32_t v) { return With == plain || (!general && (v & ~31u) >= patch.special); };
      const auto is_lawless = [&](std::uint32_t v)
      { return With == lawless || (!general && (v & ~31u) >= patch.laws); };
      const auto fetch = [&](std::uint32_t v) {
        return is_plain(v) ? fetch_voxel<plain>(g, patch.voxel_begin + v) : fetch_voxel<With>(g, patch.voxel_begin + v);
      };
      // threads that compute voxels; the others find forces of shells
      const std::uint32_t workers = threads - (has<With, Effects::shell> ? shell.threads : 0);
      const bool works = threadIdx.x < workers;
      if (works && threadIdx.x < patch.voxels)
        voxel = fetch(threadIdx.x);
      for (std::uint32_t h = threadIdx.x; h < patch.halo; h += threads)
      {
        const float4* const from = u + __ldg(g.halo + patch.halo_begin + h);
        memory.place[h] = step == g.step_begin ? *from : receive(from, mark(g, step));
      }
      if (has<With, Effects::touch>)
        await_touch(g, touch);
      __syncthreads();
      if (has<With, Effects::contact>)
        look_at_watched(g, contact, memory, watch);
      if (has<With, Effects::touch>)
        place_touch(g, touch, memory);
      if (has<With, Effects::shell> && !works)
        find_shell(g, shell, memory);
      for (std::uint32_t v = threadIdx.x; works && v < patch.voxels; v += workers)
      {
        if (v != threadIdx.x)
          voxel = fetch(v);
        if (is_plain(v))
          put_forces<plain>(g, voxel, activation, 0, with_bound, memory, v);
        else if (is_lawless(v))
          put_forces<lawless>(g, voxel, activation, relaxes, with_bound, memory, v);
        else
          put_forces<With>(g, voxel, activation, relaxes, with_bound, memory, v);
      }
      if (has<With, Effects::touch>)
        find_touch(g, touch, memory);
      end_voxels<With>(g, contact, watch, memory, step, memory.least + round, until[turn]);
      if (has<With, Effects::shell>)
        add_shell(shell, memory);
      if (has<With, Effects::touch>)
        add_touch(g, touch, memory);
      const bool last = step + 1 == g.step_end;
      for (std::uint32_t n = threadIdx.x; n < patch.nodes; n += threads)
        step_patch_node<With>(g, memory, patch.first_node + n, filled + n, launch, n < patch.border, last,
                              g.u[1 - present], step);
      if (with_bound)
        for (std::uint32_t n = threadIdx.x; n < patch.nodes; n += threads)
          if (__ldg(g.patch_tasks + patch.first_node + n) != patch_task::still)
            frequency_bits = max(frequency_bits, bound_of_node<With>(g, memory, patch, patch.first_node + n,
                                                                     memory.place[launch.most_halo + filled + n].w));
      if constexpr (has<With, Effects::groups>)
      {
        const GroupStep groups = fetch_groups(g, launch, memory, p, kept_groups);
        if (!g.forces_only)
          move_groups(g, launch, memory, patch, groups, filled, last, g.u[1 - present], step);
        kept_groups += groups.words;
      }
      filled += patch.nodes;
      kept += shell.words;
    }
    if (with_bound)
    {
      const std::uint32_t largest = largest_of_warp(frequency_bits);
      if ((threadIdx.x & 31) == 0)
        atomicMax(g.frequency_bound, largest);
    }
  }
}

/// The patch kernel for a set of effects. `Nodes`: the set's effects of nodes.
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

/// Kernels are in separate translation units, because nvcc gives every kernel that calls functions through a table the
/// registers of the largest function in all tables of the unit.
const void* sliding_patch_kernel(Effects effects);
const void* friction_patch_kernel(Effects effects);
const void* contact_patch_kernel(Effects effects);
const void* shell_patch_kernel(Effects effects);
const void* touch_patch_kernel(Effects effects);
const void* whole_patch_kernel(Effects effects);
const void* group_patch_kernel(Effects effects);
const void* contact_group_patch_kernel(Effects effects);
const void* whole_group_patch_kernel(Effects effects);

}  // namespace cuda
}  // namespace frontalis
