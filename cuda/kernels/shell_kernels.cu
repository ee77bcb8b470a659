#include "cuda/kernels/shell_kernels.hpp"

#include "cuda/kernels/launch_after.cuh"
#include "cuda/kernels/shell_triangles.cuh"

namespace frontalis
{
namespace cuda
{

// In strips, shells have kernels of their own, which run before each step. Their forces change the velocities of nodes.

constexpr int block = 128;

__global__ void __launch_bounds__(block) place_vertices(const BoundPoints points, const float4* u, float4* moved)
{
  let_next_kernel_start();
  const std::uint32_t v = blockIdx.x * block + threadIdx.x;
  if (v >= points.point_count)
    return;
  const float4 coordinates = points.coordinates[v];
  const uint4 low = points.nodes[2 * v], high = points.nodes[2 * v + 1];
  wait_for_kernel_before();
  const physics::Vec3<float> at = bound_displacement(coordinates, low, high, u);
  moved[v] = make_float4(at.x, at.y, at.z, 0);
}

__global__ void __launch_bounds__(block) find_forces(const ShellTriangles triangles, const float4* moved, float* forces)
{
  let_next_kernel_start();
  wait_for_kernel_before();
  const std::uint32_t t = blockIdx.x * block + threadIdx.x;
  if (t < triangles.count)
    put_shell_forces(triangles, t, moved, forces, triangles.count);
}

__global__ void __launch_bounds__(block)
    sum_forces(const ShellSums of, const BoundPoints points, std::uint32_t triangles, const float* forces)
{
  let_next_kernel_start();
  const std::uint32_t v = blockIdx.x * block + threadIdx.x;
  if (v >= points.point_count)
    return;
  const uint2 sum = of.sums[v];
  wait_for_kernel_before();
  physics::Vec3<float> force{ 0, 0, 0 };
  for (std::uint32_t k = sum.x; k < sum.x + sum.y; ++k)
    force = force + shell_force(forces + of.terms[k], triangles);
  points.pushes[v] = make_float4(force.x, force.y, force.z, 0);
}

namespace
{

int blocks(std::uint32_t count) { return static_cast<int>((count + block - 1) / block); }

}  // namespace
}  // namespace cuda

cudaError_t launch_shell_forces(const ShellTriangles& triangles, const ShellSums& sums, const BoundPoints& points,
                                const float4* u, float4* moved, float* forces, cudaStream_t stream)
{
  const int vertices = cuda::blocks(points.point_count);
  cudaError_t status = cuda::launch_after(cuda::place_vertices, vertices, cuda::block, stream, points, u, moved);
  if (status == cudaSuccess)
    status = cuda::launch_after(cuda::find_forces, cuda::blocks(triangles.count), cuda::block, stream, triangles, moved,
                                forces);
  if (status == cudaSuccess)
    status = cuda::launch_after(cuda::sum_forces, vertices, cuda::block, stream, sums, points, triangles.count, forces);
  return status;
}

}  // namespace frontalis
