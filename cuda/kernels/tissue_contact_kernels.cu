#include "cuda/kernels/tissue_contact_kernels.hpp"

#include "cuda/kernels/launch_after.cuh"
#include "cuda/kernels/push_nodes.cuh"
#include "cuda/kernels/tissue_contact_search.cuh"
#include "frontalis/physics/sliding.hpp"

namespace frontalis
{
namespace cuda
{

/// Velocities of device nodes [m/s].
struct Velocities
{
  const float* v[3];
};

// Small blocks spread a few thousand vertices over all multiprocessors.
constexpr std::uint32_t touch_block = 64;

__global__ void __launch_bounds__(touch_block)
    place_vertices(const __grid_constant__ TissueContactArguments c, const float4* u)
{
  let_next_kernel_start();
  const std::uint32_t v = blockIdx.x * touch_block + threadIdx.x;
  if (v < c.vertex_count)
    place_touching(c, v, u, wait_for_kernel_before);
}

template <bool rubs>
__global__ void __launch_bounds__(touch_block)
    touch_surfaces(const __grid_constant__ TissueContactArguments c, float response)
{
  let_next_kernel_start();
  const std::uint32_t v = blockIdx.x * touch_block + threadIdx.x;
  if (v < c.vertex_count)
    touch_triangles<rubs>(c, v, response, wait_for_kernel_before);
}

// Kernels search before the steps of a plan. Each waits for the one before it, because all threads must have
// reached the same point.

__global__ void __launch_bounds__(touch_block)
    look_ahead(const __grid_constant__ TissueContactArguments c, const float4* u, const Velocities velocities)
{
  let_next_kernel_start();
  const std::uint32_t v = blockIdx.x * touch_block + threadIdx.x;
  float moved = 0, speed = 0;
  if (v < c.vertex_count)
  {
    place_touching(c, v, u, wait_for_kernel_before);
    moved = norm(place(c.placed[v]) - place(c.searched[v]));
    speed = speed_of(c, v, velocities.v);
  }
  else
    wait_for_kernel_before();
#pragma unroll
  for (int apart = 1; apart < 32; apart *= 2)
  {
    moved = fmaxf(moved, __shfl_xor_sync(0xffffffffu, moved, apart));
    speed = fmaxf(speed, __shfl_xor_sync(0xffffffffu, speed, apart));
  }
  if (threadIdx.x % 32 == 0)
  {
    atomicMax(&c.control->moved, __float_as_uint(moved));
    atomicMax(&c.control->speed, __float_as_uint(speed));
  }
  clear_grid(c, v, gridDim.x * touch_block);
  for (std::uint32_t i = v; i < c.in_patches.copy_count; i += gridDim.x * touch_block)
    c.in_patches.before[i] = c.moved[c.in_patches.vertex_of[i] & ~touch_mark];
}

__global__ void __launch_bounds__(touch_block)
    sort_triangles(const __grid_constant__ TissueContactArguments c, float seconds)
{
  let_next_kernel_start();
  wait_for_kernel_before();
  const TouchReach far(c, seconds);
  if (far.needed)
    for (std::uint32_t t = blockIdx.x * touch_block + threadIdx.x; t < c.triangle_count; t += gridDim.x * touch_block)
      sort_triangle(c, t, far.cell);
}

__global__ void __launch_bounds__(touch_block)
    find_pairs(const __grid_constant__ TissueContactArguments c, float seconds, float dt)
{
  wait_for_kernel_before();
  const std::uint32_t v = blockIdx.x * touch_block + threadIdx.x;
  const TouchReach far(c, seconds);
  if (v < c.vertex_count)
  {
    if (far.needed)
      search_pairs(c, far, v);
    if (c.in_patches.patches != nullptr)
    {
      begin_pairs(c, v);
      list_vertex(c, v);
    }
  }
  // The last block ends the search.
  __threadfence();
  __syncthreads();
  if (threadIdx.x == 0 && atomicAdd(&c.control->done, 1u) + 1 == gridDim.x)
    end_search(c, far, dt);
}

__global__ void __launch_bounds__(touch_block) touch_springs(const TissueContactArguments c, const float4* u)
{
  const std::uint32_t v = blockIdx.x * touch_block + threadIdx.x;
  if (v >= c.vertex_count)
    return;
  const Place moved = bound_displacement(c.bound.coordinates[v], c.bound.nodes[2 * v], c.bound.nodes[2 * v + 1], u);
  // The factor 4 is 2 x 2: a vertex has only half of the contact's stiffness, because both sides push, and the
  // stiffness counts twice, because the spring joins two masses that move.
  const float units = -4 * c.per_newton * c.vertices[v].stiffness;
  const auto in_units = [&](float x) { return static_cast<unsigned long long>(__float2ll_rn(units * x)); };
  c.sums[v] = { { in_units(moved.x), in_units(moved.y), in_units(moved.z) }, { 0, 0, 0 } };
}

__global__ void __launch_bounds__(push_block)
    push_touching(const __grid_constant__ TissueContactArguments c, const PushTarget to)
{
  push_node(c.bound, to, wait_for_kernel_before,
            [&](std::uint32_t v, std::uint32_t b) { return corner_push(c, v, b); });
}

namespace
{

std::uint32_t touch_blocks(const TissueContactArguments& contact)
{
  return (contact.vertex_count + touch_block - 1) / touch_block;
}

}  // namespace
}  // namespace cuda

cudaError_t launch_touch_search(const TissueContactArguments& contact, const float4* u, const float* const (&v)[3],
                                double dt, int steps, cudaStream_t stream)
{
  const std::uint32_t blocks = cuda::touch_blocks(contact);
  const auto seconds = static_cast<float>(dt * steps);
  cudaError_t status = cudaSuccess;
  const auto then = [&](auto kernel, std::uint32_t blocks, const auto&... arguments)
  {
    if (status == cudaSuccess)
      status = cuda::launch_after(kernel, blocks, cuda::touch_block, stream, contact, arguments...);
  };
  then(cuda::look_ahead, blocks, u, cuda::Velocities{ { v[0], v[1], v[2] } });
  then(cuda::sort_triangles, blocks, seconds);
  then(cuda::find_pairs, blocks, seconds, static_cast<float>(dt));
  return status;
}

cudaError_t launch_touch(const TissueContactArguments& contact, const float4* u, double dt, cudaStream_t stream)
{
  const std::uint32_t blocks = cuda::touch_blocks(contact);
  const auto response = static_cast<float>(physics::friction_response(dt));
  if (const auto status = cuda::launch_after(cuda::place_vertices, blocks, cuda::touch_block, stream, contact, u);
      status != cudaSuccess)
    return status;
  const auto touch = contact.rubs ? cuda::touch_surfaces<true> : cuda::touch_surfaces<false>;
  return cuda::launch_after(touch, blocks, cuda::touch_block, stream, contact, response);
}

cudaError_t launch_touch_springs(const TissueContactArguments& contact, const float4* u, cudaStream_t stream)
{
  cuda::touch_springs<<<cuda::touch_blocks(contact), cuda::touch_block, 0, stream>>>(contact, u);
  return cudaGetLastError();
}

cudaError_t launch_push_touching(const StepArguments& g, const TissueContactArguments& contact, float factor,
                                 float* const (&v)[3], cudaStream_t stream)
{
  return cuda::launch_after(cuda::push_touching, cuda::push_blocks(contact.bound), cuda::push_block, stream, contact,
                            cuda::push_target(g, factor, v));
}

}  // namespace frontalis
