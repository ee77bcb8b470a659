#include "cuda/kernels/tissue_contact_kernels.hpp"

#include "cuda/kernels/push_nodes.cuh"
#include "cuda/kernels/tissue_contact.cuh"
#include "frontalis/physics/sliding.hpp"

namespace frontalis
{
namespace cuda
{

// Small blocks spread a few thousand vertices over all multiprocessors.
constexpr std::uint32_t touch_block = 64;

__global__ void __launch_bounds__(touch_block) place_vertices(const TissueContactArguments c, const float4* u)
{
  const std::uint32_t v = blockIdx.x * touch_block + threadIdx.x;
  clear_grid(c, v, gridDim.x * touch_block);
  float moved = v < c.vertex_count ? place_touching(c, v, u) : 0;
  if (c.looks_only)
    return;
  if (v == 0)
    c.control->stage = c.control->next;
#pragma unroll
  for (int apart = 1; apart < 32; apart *= 2)
    moved = fmaxf(moved, __shfl_xor_sync(0xffffffffu, moved, apart));
  if (threadIdx.x % 32 == 0 && __float_as_uint(moved) > c.control->moved)
    atomicMax(&c.control->moved, __float_as_uint(moved));
}

template <bool rubs>
__global__ void __launch_bounds__(touch_block)
    touch_surfaces(const __grid_constant__ TissueContactArguments c, float dt, float response)
{
  const std::uint32_t v = blockIdx.x * touch_block + threadIdx.x;
  const TouchStage stage = c.looks_only ? TouchStage::hold : c.control->stage;
  if (stage == TouchStage::sort)
  {
    const float cell = cell_edge(c);
    for (std::uint32_t t = v; t < c.triangle_count; t += gridDim.x * touch_block)
      sort_triangle(c, t, cell);
  }
  if (v >= c.vertex_count)
    return;
  if (stage == TouchStage::search)
    search_pairs(c, v);
  touch_triangles<rubs>(c, v, response);
  if (v == 0 && !c.looks_only)
    choose_stage(c, dt);
}

__global__ void __launch_bounds__(touch_block) touch_springs(const TissueContactArguments c, const float4* u)
{
  const std::uint32_t v = blockIdx.x * touch_block + threadIdx.x;
  if (v >= c.vertex_count)
    return;
  const Place moved = bound_displacement(c.bound.coordinates[v], c.bound.nodes[2 * v], c.bound.nodes[2 * v + 1], u);
  // A vertex has half of the stiffness, because both sides push; the stiffness counts twice, because both sides move.
  const float units = -4 * c.per_newton * c.vertices[v].stiffness;
  unsigned long long* const sum = c.sums + 6 * std::size_t(v);
  sum[0] = static_cast<unsigned long long>(__float2ll_rn(units * moved.x));
  sum[1] = static_cast<unsigned long long>(__float2ll_rn(units * moved.y));
  sum[2] = static_cast<unsigned long long>(__float2ll_rn(units * moved.z));
  sum[3] = sum[4] = sum[5] = 0;
}

__global__ void __launch_bounds__(push_block)
    push_touching(const __grid_constant__ TissueContactArguments c, const PushTarget to)
{
  push_node(c.bound, to,
            [&](std::uint32_t v, std::uint32_t b) {
              return has_push(c, v) ? corner_push(c, v, static_cast<int>(b)) : Place{ 0, 0, 0 };
            });
}

namespace
{

std::uint32_t blocks(const TissueContactArguments& contact)
{
  return (contact.vertex_count + touch_block - 1) / touch_block;
}

}  // namespace
}  // namespace cuda

cudaError_t launch_touch(const TissueContactArguments& contact, const float4* u, double dt, cudaStream_t stream)
{
  const std::uint32_t blocks = cuda::blocks(contact);
  const auto response = static_cast<float>(physics::friction_response(dt));
  cuda::place_vertices<<<blocks, cuda::touch_block, 0, stream>>>(contact, u);
  const auto touch = contact.rubs ? cuda::touch_surfaces<true> : cuda::touch_surfaces<false>;
  touch<<<blocks, cuda::touch_block, 0, stream>>>(contact, static_cast<float>(dt), response);
  return cudaGetLastError();
}

cudaError_t launch_touch_springs(const TissueContactArguments& contact, const float4* u, cudaStream_t stream)
{
  cuda::touch_springs<<<cuda::blocks(contact), cuda::touch_block, 0, stream>>>(contact, u);
  return cudaGetLastError();
}

cudaError_t launch_push_touching(const StepArguments& g, const TissueContactArguments& contact, float factor,
                                 float* const (&v)[3], cudaStream_t stream)
{
  cuda::push_touching<<<cuda::push_blocks(contact.bound), cuda::push_block, 0, stream>>>(
      contact, cuda::push_target(g, factor, v));
  return cudaGetLastError();
}

}  // namespace frontalis
