#include "frontalis/physics/trilinear.hpp"
#include "cuda/kernels/acting_load.cuh"
#include "cuda/kernels/launch_after.cuh"
#include "cuda/kernels/surface_kernels.hpp"

namespace frontalis
{
namespace cuda
{

constexpr int block = 128;

// A vertex of a surface, which does not change.
struct BoundVertex
{
  std::uint32_t nodes[8];
  float coordinates[3];
  physics::Vec3<double> rest;
};

__device__ BoundVertex bound_vertex(const BoundSurface& s, std::uint32_t v)
{
  BoundVertex vertex;
  for (int b = 0; b < 8; ++b)
    vertex.nodes[b] = s.nodes[8 * v + b];
  for (int i = 0; i < 3; ++i)
    vertex.coordinates[i] = s.coordinates[3 * v + i];
  vertex.rest = { s.rest[3 * v], s.rest[3 * v + 1], s.rest[3 * v + 2] };
  return vertex;
}

__device__ physics::Vec3<double> position_of(const BoundVertex& vertex, const float4* u)
{
  double weight[8];
  physics::trilinear_weights<double>(vertex.coordinates[0], vertex.coordinates[1], vertex.coordinates[2], weight);
  physics::Vec3<double> moved{ 0, 0, 0 };
  for (int b = 0; b < 8; ++b)
  {
    const float4 node = u[vertex.nodes[b]];
    moved = moved + weight[b] * physics::Vec3<double>{ node.x, node.y, node.z };
  }
  return vertex.rest + moved;
}

__global__ void place(const BoundSurface s, const float4* u, float* positions)
{
  const std::uint32_t v = blockIdx.x * block + threadIdx.x;
  if (v >= s.vertex_count)
    return;
  const auto at = position_of(bound_vertex(s, v), u);
  positions[3 * v] = static_cast<float>(at.x);
  positions[3 * v + 1] = static_cast<float>(at.y);
  positions[3 * v + 2] = static_cast<float>(at.z);
}

__device__ physics::Vec3<float> vertex(const float* positions, int v)
{
  return { positions[3 * v], positions[3 * v + 1], positions[3 * v + 2] };
}

// Twice the sum of the area vectors of the triangles around a vertex, in a fixed order.
__device__ physics::Vec3<float> area_around(const BoundSurface& s, const float* positions, std::uint32_t v)
{
  physics::Vec3<float> sum{ 0, 0, 0 };
  for (auto t = s.around_begin[v]; t < s.around_begin[v + 1]; ++t)
  {
    const int3 corner = s.triangles[s.around[t]];
    const auto a = vertex(positions, corner.x);
    sum = sum + cross(vertex(positions, corner.y) - a, vertex(positions, corner.z) - a);
  }
  return sum;
}

__global__ void normals(const BoundSurface s, const float* positions, float* out)
{
  const std::uint32_t v = blockIdx.x * block + threadIdx.x;
  if (v >= s.vertex_count)
    return;
  const auto sum = area_around(s, positions, v);
  const float length = norm(sum);
  out[3 * v] = length > 0 ? sum.x / length : 0;
  out[3 * v + 1] = length > 0 ? sum.y / length : 0;
  out[3 * v + 2] = length > 0 ? sum.z / length : 0;
}

__global__ void pressure_forces(const BoundSurface s, const double* pressure, const float4* u, double* forces)
{
  let_next_kernel_start();
  const std::uint32_t t = blockIdx.x * block + threadIdx.x;
  const int3 corner = s.triangles[min(t, s.triangle_count - 1)];
  const BoundVertex a = bound_vertex(s, corner.x), b = bound_vertex(s, corner.y), c = bound_vertex(s, corner.z);
  wait_for_kernel_before();
  if (t >= s.triangle_count)
    return;
  const auto at = position_of(a, u);
  const auto force = -pressure[t] / 6 * cross(position_of(b, u) - at, position_of(c, u) - at);
  forces[3 * t] = force.x;
  forces[3 * t + 1] = force.y;
  forces[3 * t + 2] = force.z;
}

// A warp adds the parts of a node's force, of which coarse voxels have hundreds, in a fixed order.
__global__ void node_loads(const __grid_constant__ StepArguments g, std::uint32_t count, int step, double* forces)
{
  let_next_kernel_start();
  const std::uint32_t i = blockIdx.x * block + threadIdx.x, n = i / warpSize, lane = i % warpSize;
  wait_for_kernel_before();
  if (n >= count)
    return;
  double force[3] = { 0, 0, 0 };
  for (std::int32_t p = g.load_begin[n] + static_cast<std::int32_t>(lane); p < g.load_begin[n + 1]; p += warpSize)
  {
    const LoadPart part = g.load_parts[p];
    const double share = part.weight * acting_share(g, part.load, step);
    for (int axis = 0; axis < 3; ++axis)
      force[axis] += share * g.surface_force[3 * part.force + axis];
  }
  for (int apart = 1; apart < warpSize; apart *= 2)
    for (double& component : force)
      component += __shfl_xor_sync(0xffffffffu, component, apart);
  if (lane < 3)
    forces[3 * n + lane] = lane == 0 ? force[0] : lane == 1 ? force[1] : force[2];
}

__global__ void hold(const std::uint32_t* nodes, std::uint32_t count, float4* u)
{
  const std::uint32_t n = blockIdx.x * block + threadIdx.x;
  if (n < count)
    u[nodes[n]] = make_float4(0, 0, 0, u[nodes[n]].w);
}

namespace
{

int blocks(std::uint32_t count) { return static_cast<int>((count + block - 1) / block); }

}  // namespace
}  // namespace cuda

cudaError_t launch_place(const BoundSurface& surface, const float4* u, float* positions, cudaStream_t stream)
{
  if (surface.vertex_count > 0)
    cuda::place<<<cuda::blocks(surface.vertex_count), cuda::block, 0, stream>>>(surface, u, positions);
  return cudaGetLastError();
}

cudaError_t launch_normals(const BoundSurface& surface, const float* positions, float* normals, cudaStream_t stream)
{
  if (surface.vertex_count > 0)
    cuda::normals<<<cuda::blocks(surface.vertex_count), cuda::block, 0, stream>>>(surface, positions, normals);
  return cudaGetLastError();
}

cudaError_t launch_pressure(const BoundSurface& surface, const double* pressure, const float4* u, double* forces,
                            cudaStream_t stream)
{
  return cuda::launch_after(cuda::pressure_forces, cuda::blocks(surface.triangle_count), cuda::block, stream, surface,
                            pressure, u, forces);
}

cudaError_t launch_node_loads(const StepArguments& arguments, std::uint32_t count, int step, double* forces,
                              cudaStream_t stream)
{
  constexpr std::uint32_t warp = 32;
  return cuda::launch_after(cuda::node_loads, cuda::blocks(warp * count), cuda::block, stream, arguments, count, step,
                            forces);
}

cudaError_t launch_hold(const std::uint32_t* nodes, std::uint32_t count, float4* u, cudaStream_t stream)
{
  if (count > 0)
    cuda::hold<<<cuda::blocks(count), cuda::block, 0, stream>>>(nodes, count, u);
  return cudaGetLastError();
}

}  // namespace frontalis
