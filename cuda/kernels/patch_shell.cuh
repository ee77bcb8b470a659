#pragma once

#include "cuda/kernels/patch_contact.cuh"
#include "cuda/kernels/shell_triangles.cuh"

namespace frontalis
{
namespace cuda
{

// Shells in patches, whose shared memory they use. A patch computes every triangle that it needs, some of which others
// compute as well, so that nothing but displacements of nodes is exchanged.

__device__ __forceinline__ PatchShell fetch_shell(const StepArguments& g, std::uint32_t p)
{
  return g.shell.patches == nullptr || (g.forces_only && !g.shell.spring) ? PatchShell{} : g.shell.patches[p];
}

/// Places the vertices. A barrier must follow.
__device__ __forceinline__ void place_shell(const StepArguments& g, const PatchShell& shell, const PatchMemory& memory)
{
  for (std::uint32_t v = threadIdx.x; v < shell.vertices; v += blockDim.x)
  {
    const std::size_t index = shell.vertex_begin + v;
    const physics::Vec3<float> moved =
        bound_displacement(__ldg(g.shell.coordinates + index), __ldg(g.shell.corners + 2 * index),
                           __ldg(g.shell.corners + 2 * index + 1), memory.place);
    memory.shell[v] = make_float4(moved.x, moved.y, moved.z, 0);
  }
}

/// Adds the forces on vertices to those on the corners of their voxels, in the order of the vertices. Eight threads
/// have a voxel: they share the sum of the force on a vertex, then each adds its part to a corner.
__device__ __forceinline__ void add_shell(const StepArguments& g, const PatchShell& shell, const PatchMemory& memory)
{
  // all threads have the same answer
  if (shell.triangles == 0)
    return;
  float* const forces = reinterpret_cast<float*>(memory.shell + shell.vertices);
  for (std::uint32_t t = threadIdx.x; t < shell.triangles; t += blockDim.x)
    put_shell_forces(g.shell, shell, t, memory.shell, forces);
  __syncthreads();
  const unsigned group = 0xffu << (threadIdx.x & 24u);
  for (std::uint32_t i = threadIdx.x; i < 8 * shell.voxels; i += blockDim.x)
  {
    const BoundVoxel voxel = g.shell.voxels[shell.voxel_begin + i / 8];
    const std::uint32_t b = i % 8;
    physics::Vec3<float> sum{ 0, 0, 0 };
    for (std::uint32_t v = voxel.first; v < voxel.end; ++v)
    {
      physics::Vec3<float> force = sum_shell_forces(g.shell, shell, v, b, 8, forces);
#pragma unroll
      for (int apart = 1; apart < 8; apart *= 2)
        force = force + physics::Vec3<float>{ __shfl_xor_sync(group, force.x, apart),
                                              __shfl_xor_sync(group, force.y, apart),
                                              __shfl_xor_sync(group, force.z, apart) };
      const float4 at = __ldg(g.shell.coordinates + shell.vertex_begin + v);
      sum = sum + corner_weight(b, at.x, at.y, at.z) * force;
    }
    float* const to = memory.force + 3 * b * memory.width + voxel.column;
    // internal forces have the opposite sign
    to[0] -= sum.x;
    to[memory.width] -= sum.y;
    to[2 * memory.width] -= sum.z;
  }
  __syncthreads();
}

}  // namespace cuda
}  // namespace frontalis
