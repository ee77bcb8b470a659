#pragma once

#include "cuda/kernels/patch_contact.cuh"
#include "cuda/kernels/shell_triangles.cuh"

namespace frontalis
{
namespace cuda
{

// Shells in patches. They use part of the patches' shared memory. A patch computes all triangles that it needs, even if
// other patches compute them as well, so that only displacements of nodes have to be exchanged. The last threads of a
// block find the forces on vertices while the others compute voxels.

/// The shells of a patch in a step.
struct ShellStep
{
  PatchShell patch;
  std::uint32_t table;      ///< first word of the patch's table in PatchMemory::tables
  const float4* triangles;  ///< in shared memory if there is room, else in global memory
  std::uint32_t words;      ///< number of words of the table in shared memory
  std::uint32_t threads;    ///< number of threads that find the forces; 0 if there are none
};

/// The shells of patch p in a step. `kept`: number of words of shared memory that hold tables of the block's earlier
/// patches.
__device__ __forceinline__ ShellStep fetch_shell(const StepArguments& g, const StepLaunch& launch,
                                                 const PatchMemory& memory, std::uint32_t p, std::uint32_t kept)
{
  if (g.shell.patches == nullptr)
    return {};
  ShellStep shell{ g.shell.patches[p], kept, nullptr, 0, 0 };
  const bool all = launch.room.keeps_triangles;
  shell.words = shell.patch.table_words + (all ? shell_words * shell.patch.triangles : 0);
  const uint4* const whole = all ? memory.tables + kept : g.shell.tables + shell.patch.table_begin;
  shell.triangles = reinterpret_cast<const float4*>(whole + shell.patch.table_words);
  if (shell.patch.triangles > 0 && (!g.forces_only || g.shell.spring))
    shell.threads = launch.room.shell_threads;
  return shell;
}

/// Copies the table of patch p to shared memory, at the start of a launch. Returns its number of words. `kept`: see
/// fetch_shell().
__device__ __forceinline__ std::uint32_t keep_shell(const StepArguments& g, const StepLaunch& launch,
                                                    const PatchMemory& memory, std::uint32_t p, std::uint32_t kept)
{
  const ShellStep shell = fetch_shell(g, launch, memory, p, kept);
  for (std::uint32_t w = threadIdx.x; w < shell.words; w += blockDim.x)
    memory.tables[kept + w] = g.shell.tables[shell.patch.table_begin + w];
  return shell.words;
}

/// Waits for the other threads that find forces of shells.
__device__ __forceinline__ void await_shell(const ShellStep& shell)
{
  asm volatile("bar.sync 1, %0;" ::"r"(shell.threads) : "memory");
}

/// Finds the forces on the vertices in the patch's voxels, which take the place of their displacements. To be called by
/// the last `shell.threads` threads of the block. Loops are not unrolled: the step's instructions would no longer fit
/// the cache.
__device__ __forceinline__ void find_shell(const StepArguments& g, const ShellStep& shell, const PatchMemory& memory)
{
  const PatchShell& patch = shell.patch;
  const std::uint32_t thread = threadIdx.x + shell.threads - blockDim.x;
  const uint4* const table = memory.tables + shell.table;
  const auto* const coordinates = reinterpret_cast<const float4*>(table);
#pragma unroll 1
  for (std::uint32_t v = thread; v < patch.vertices; v += shell.threads)
  {
    std::uint32_t corner[8];
    split(table[patch.vertices + v], corner);
    const float4 at = coordinates[v];
    float weight[8];
    physics::trilinear_weights(at.x, at.y, at.z, weight);
    physics::Vec3<float> moved{ 0, 0, 0 };
#pragma unroll
    for (int b = 0; b < 8; ++b)
      add_part(moved, weight[b], memory.place[corner[b]]);
    memory.shell[v] = make_float4(moved.x, moved.y, moved.z, 0);
  }
  await_shell(shell);
  float* const forces = reinterpret_cast<float*>(memory.shell + patch.vertices);
#pragma unroll 1
  for (std::uint32_t t = thread; t < patch.triangles; t += shell.threads)
    put_shell_forces({ shell.triangles, patch.triangles, g.shell.spring }, t, memory.shell, forces,
                     patch.triangles + 1);
  if (thread < 18)
    forces[thread * (patch.triangles + 1) + patch.triangles] = 0;
  await_shell(shell);
  const auto* const terms = reinterpret_cast<const uint2*>(table + 2 * patch.vertices + (patch.voxels + 1) / 2);
#pragma unroll 1
  for (std::uint32_t v = thread; v < patch.own; v += shell.threads)
  {
    const std::uint32_t word = __float_as_uint(coordinates[v].w), last = (word & 0xfffffu) + (word >> 20);
    physics::Vec3<float> force{ 0, 0, 0 };
#pragma unroll 1
    for (std::uint32_t k = word & 0xfffffu; k < last; ++k)
    {
      const uint2 four = terms[k];
      const physics::Vec3<float> of[4] = { shell_force(forces + (four.x & 0xffffu), patch.triangles + 1),
                                           shell_force(forces + (four.x >> 16), patch.triangles + 1),
                                           shell_force(forces + (four.y & 0xffffu), patch.triangles + 1),
                                           shell_force(forces + (four.y >> 16), patch.triangles + 1) };
      force = force + ((of[0] + of[1]) + (of[2] + of[3]));
    }
    memory.shell[v] = make_float4(force.x, force.y, force.z, 0);
  }
}

/// Adds the forces on vertices to those on the corners of their voxels, in the order of the vertices. Each thread
/// processes a corner of a voxel. Ends with a barrier.
__device__ __forceinline__ void add_shell(const ShellStep& shell, const PatchMemory& memory)
{
  // The condition has the same value in all threads.
  if (shell.threads == 0)
    return;
  const PatchShell& patch = shell.patch;
  const uint4* const table = memory.tables + shell.table;
  const auto* const coordinates = reinterpret_cast<const float4*>(table);
  const auto* const voxels = reinterpret_cast<const uint2*>(table + 2 * patch.vertices);
#pragma unroll 1
  for (std::uint32_t i = threadIdx.x; i < 8 * patch.voxels; i += blockDim.x)
  {
    const uint2 voxel = voxels[i / 8];
    const std::uint32_t b = i % 8, first = voxel.y & 0xffffu, end = first + (voxel.y >> 16);
    physics::Vec3<float> sum{ 0, 0, 0 };
#pragma unroll 1
    for (std::uint32_t v = first; v < end; ++v)
    {
      const float4 at = coordinates[v];
      add_part(sum, corner_weight(b, at.x, at.y, at.z), memory.shell[v]);
    }
    float* const to = memory.force + 3 * b * memory.width + voxel.x;
    // Internal forces have the opposite sign.
    to[0] -= sum.x;
    to[memory.width] -= sum.y;
    to[2 * memory.width] -= sum.z;
  }
  __syncthreads();
}

}  // namespace cuda
}  // namespace frontalis
