#include "cuda/kernels/shell_kernels.hpp"

#include "cuda/kernels/shell_triangles.cuh"

namespace frontalis
{
namespace cuda
{

// In strips, shells have kernels of their own before each step. Their forces become changes of the nodes' velocities.

constexpr int block = 128;

__global__ void __launch_bounds__(block) place_vertices(const BoundPoints points, const float4* u, float4* moved)
{
  const std::uint32_t v = blockIdx.x * block + threadIdx.x;
  if (v >= points.point_count)
    return;
  const physics::Vec3<float> at =
      bound_displacement(points.coordinates[v], points.nodes[2 * v], points.nodes[2 * v + 1], u);
  moved[v] = make_float4(at.x, at.y, at.z, 0);
}

__global__ void __launch_bounds__(block)
    find_forces(const ShellArguments s, const PatchShell all, const float4* moved, float* forces)
{
  const std::uint32_t t = blockIdx.x * block + threadIdx.x;
  if (t < all.triangles)
    put_shell_forces(s, all, t, moved, forces);
}

__global__ void __launch_bounds__(block)
    sum_forces(const ShellArguments s, const PatchShell all, const float* forces, float4* pushes)
{
  const std::uint32_t v = blockIdx.x * block + threadIdx.x;
  if (v >= all.vertices)
    return;
  const physics::Vec3<float> force = sum_shell_forces(s, all, v, 0, 1, forces);
  pushes[v] = make_float4(force.x, force.y, force.z, 0);
}

namespace
{

int blocks(std::uint32_t count) { return static_cast<int>((count + block - 1) / block); }

}  // namespace
}  // namespace cuda

cudaError_t launch_shell_forces(const ShellArguments& shell, const PatchShell& all, const BoundPoints& points,
                                const float4* u, float4* moved, float* forces, cudaStream_t stream)
{
  cuda::place_vertices<<<cuda::blocks(points.point_count), cuda::block, 0, stream>>>(points, u, moved);
  cuda::find_forces<<<cuda::blocks(all.triangles), cuda::block, 0, stream>>>(shell, all, moved, forces);
  cuda::sum_forces<<<cuda::blocks(all.vertices), cuda::block, 0, stream>>>(shell, all, forces, points.pushes);
  return cudaGetLastError();
}

}  // namespace frontalis
