#pragma once

#include "cuda/kernels/patch_contact.cuh"
#include "cuda/kernels/shell_triangles.cuh"

namespace frontalis
{
namespace cuda
{

// Shells in patches. They use part of the patches' shared memory. A patch computes all triangles that it needs, even if
// other patches compute them as well, so that only displacements of nodes have to be exchanged.

/// The shells of a patch in a step.
struct ShellStep
{
  PatchShell patch;
  const uint4* table;       ///< table of the patch, in shared memory
  const float4* triangles;  ///< in shared memory if there is room, else in global memory
  std::uint32_t words;      ///< number of words of the table in shared memory
};

/// The shells of patch p in a step. `kept`: number of words of shared memory that hold tables of the block's earlier
/// patches.
__device__ __forceinline__ ShellStep fetch_shell(const StepArguments& g, const StepLaunch& launch,
                                                 const PatchMemory& memory, std::uint32_t p, std::uint32_t kept)
{
  if (g.shell.patches == nullptr)
    return {};
  ShellStep shell{ g.shell.patches[p], memory.tables + kept, nullptr, 0 };
  const bool all = launch.room.keeps_triangles;
  shell.words = shell.patch.table_words + (all ? shell_words * shell.patch.triangles : 0);
  const uint4* const whole = all ? shell.table : g.shell.tables + shell.patch.table_begin;
  shell.triangles = reinterpret_cast<const float4*>(whole + shell.patch.table_words);
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

/// Finds the displacements of the vertices. A barrier must follow.
__device__ __forceinline__ void place_shell(const ShellStep& shell, const PatchMemory& memory)
{
  for (std::uint32_t v = threadIdx.x; v < shell.patch.vertices; v += blockDim.x)
  {
    std::uint32_t corner[8];
    split(shell.table[shell.patch.vertices + v], corner);
    const float4 at = reinterpret_cast<const float4*>(shell.table)[v];
    float weight[8];
    physics::trilinear_weights(at.x, at.y, at.z, weight);
    physics::Vec3<float> moved{ 0, 0, 0 };
#pragma unroll
    for (int b = 0; b < 8; ++b)
      add_part(moved, weight[b], memory.place[corner[b]]);
    memory.shell[v] = make_float4(moved.x, moved.y, moved.z, 0);
  }
}

/// Adds the forces on vertices to those on the corners of their voxels, in the order of the vertices. Eight threads
/// process a voxel: together they sum the force on a vertex, then each adds its part to a corner.
__device__ __forceinline__ void add_shell(const StepArguments& g, const ShellStep& shell, const PatchMemory& memory)
{
  const PatchShell& patch = shell.patch;
  // The condition has the same value in all threads.
  if (patch.triangles == 0 || (g.forces_only && !g.shell.spring))
    return;
  float* const forces = reinterpret_cast<float*>(memory.shell + patch.vertices);
  for (std::uint32_t t = threadIdx.x; t < patch.triangles; t += blockDim.x)
    put_shell_forces({ shell.triangles, patch.triangles, g.shell.spring }, t, memory.shell, forces);
  __syncthreads();
  const auto* const coordinates = reinterpret_cast<const float4*>(shell.table);
  const auto* const voxels = reinterpret_cast<const uint2*>(shell.table + 2 * patch.vertices);
  const auto* const terms =
      reinterpret_cast<const std::uint16_t*>(shell.table + 2 * patch.vertices + (patch.voxels + 1) / 2);
  const unsigned group = 0xffu << (threadIdx.x & 24u);
  for (std::uint32_t i = threadIdx.x; i < 8 * patch.voxels; i += blockDim.x)
  {
    const uint2 voxel = voxels[i / 8];
    const std::uint32_t b = i % 8, first = voxel.y & 0xffffu, end = first + (voxel.y >> 16);
    physics::Vec3<float> sum{ 0, 0, 0 };
    for (std::uint32_t v = first; v < end; ++v)
    {
      const float4 at = coordinates[v];
      const std::uint32_t word = __float_as_uint(at.w), last = (word & 0xfffffu) + (word >> 20);
      physics::Vec3<float> force{ 0, 0, 0 };
      for (std::uint32_t k = (word & 0xfffffu) + b; k < last; k += 8)
        force = force + shell_force(forces + terms[k], patch.triangles);
#pragma unroll
      for (int apart = 1; apart < 8; apart *= 2)
        force = force + physics::Vec3<float>{ __shfl_xor_sync(group, force.x, apart),
                                              __shfl_xor_sync(group, force.y, apart),
                                              __shfl_xor_sync(group, force.z, apart) };
      sum = sum + corner_weight(b, at.x, at.y, at.z) * force;
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
