#pragma once

#include "cuda/kernels/plane_queue.cuh"

namespace frontalis
{
namespace cuda
{

/// Layout of the shared memory of a block; see patch_bytes().
struct PatchMemory
{
  float4* place;        // displacements of halo nodes, then of own nodes with their inverse mass
  float* v[3];          // velocities of own nodes
  float* force;         // [corner][component][voxel], then stiffness; the last column belongs to no voxel and stays 0
  std::uint32_t width;  // length of a row of `force`
};

__device__ __forceinline__ PatchMemory patch_memory(const StepLaunch& launch)
{
  extern __shared__ float4 all[];
  float* const v = reinterpret_cast<float*>(all + launch.most_halo + launch.most_nodes);
  return {
    all, { v, v + launch.most_nodes, v + 2 * launch.most_nodes }, v + 3 * launch.most_nodes, launch.most_voxels + 1
  };
}

__device__ __forceinline__ PlaneQueue plane_queue(const StepLaunch& launch)
{
  const PatchMemory memory = patch_memory(launch);
  return plane_queue(reinterpret_cast<std::int32_t*>(memory.force + 25 * memory.width), launch.most_nodes);
}

/// Number of threads of a block that take part in steps, and their barrier.
template <Effects With>
__device__ __forceinline__ std::uint32_t stepping_threads(const StepLaunch& launch)
{
  return has<With, Effects::sliding> ? launch.threads - finding_threads : blockDim.x;
}
template <Effects With>
__device__ __forceinline__ void meet(const StepLaunch& launch)
{
  if (has<With, Effects::sliding>)
    asm volatile("bar.sync 1, %0;" ::"r"(stepping_threads<With>(launch)) : "memory");
  else
    __syncthreads();
}

}  // namespace cuda
}  // namespace frontalis
