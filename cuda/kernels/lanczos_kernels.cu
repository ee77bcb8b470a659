#include "cuda/kernels/lanczos_kernels.hpp"
#include "cuda/kernels/launch_after.cuh"

namespace frontalis
{
namespace cuda
{

constexpr int block = 512;
static_assert(block >= lanczos_blocks, "each thread reads the sum of at most one block");

static std::uint32_t blocks_of_masters(const LanczosIteration& g) { return (g.masters + block - 1) / block; }

__device__ __forceinline__ double2 joined(const double2& a, const double2& b) { return { a.x + b.x, fmax(a.y, b.y) }; }
__device__ __forceinline__ double joined(double a, double b) { return a + b; }

__device__ __forceinline__ double of_lane(double value, int distance)
{
  return __shfl_down_sync(0xffffffffu, value, distance);
}
__device__ __forceinline__ double2 of_lane(const double2& value, int distance)
{
  return { of_lane(value.x, distance), of_lane(value.y, distance) };
}

/// Joins the values of all threads of a block in a fixed order. All threads receive the result.
template <class Value>
__device__ Value joined_by_block(Value own)
{
  __shared__ Value of_warp[block / 32];
  for (int distance = 16; distance > 0; distance /= 2)
    own = joined(own, of_lane(own, distance));
  __syncthreads();
  if (threadIdx.x % 32 == 0)
    of_warp[threadIdx.x / 32] = own;
  __syncthreads();
  Value all = of_warp[0];
  for (int warp = 1; warp < block / 32; ++warp)
    all = joined(all, of_warp[warp]);
  return all;
}

/// The sum of what all blocks have found.
template <class Value>
__device__ Value joined_blocks(const Value* of_block)
{
  return joined_by_block(threadIdx.x < lanczos_blocks ? of_block[threadIdx.x] : Value{});
}

__device__ __forceinline__ float root_of(const LanczosIteration& g, std::uint32_t node)
{
  return sqrtf(g.mobility == nullptr ? g.u[node].w : g.mobility[node]);
}

__global__ void __launch_bounds__(block) displace(const __grid_constant__ LanczosIteration g)
{
  let_next_kernel_start();
  wait_for_kernel_before();
  const float scale = static_cast<float>(g.amplitude / joined_blocks(g.size).y);
  for (std::uint32_t n = blockIdx.x * block + threadIdx.x; n < g.nodes; n += gridDim.x * block)
  {
    const float4 at = g.u[n], along = g.now[n];
    const float share = scale * root_of(g, n);
    g.moved[n] = make_float4(at.x + share * along.x, at.y + share * along.y, at.z + share * along.z, at.w);
  }
}

// One thread per master.
__global__ void __launch_bounds__(block) move_followers(const __grid_constant__ LanczosIteration g)
{
  let_next_kernel_start();
  wait_for_kernel_before();
  const std::uint32_t m = blockIdx.x * block + threadIdx.x;
  if (m >= g.masters)
    return;
  for (std::uint32_t f = g.follower_begin[m]; f < g.follower_begin[m + 1]; ++f)
  {
    const SearchFollower follower = g.followers[f];
    const float4 from = g.u[follower.master], to = g.moved[follower.master], at = g.u[follower.node];
    g.moved[follower.node] =
        make_float4(at.x + follower.ratio * (to.x - from.x), at.y + follower.ratio * (to.y - from.y),
                    at.z + follower.ratio * (to.z - from.z), at.w);
  }
}

__global__ void __launch_bounds__(block) add_forces_of_followers(const __grid_constant__ LanczosIteration g)
{
  let_next_kernel_start();
  wait_for_kernel_before();
  const std::uint32_t m = blockIdx.x * block + threadIdx.x;
  if (m >= g.masters)
    return;
  const std::uint32_t master = g.followers[g.follower_begin[m]].master;
  float4 sum = g.forces[master];
  for (std::uint32_t f = g.follower_begin[m]; f < g.follower_begin[m + 1]; ++f)
  {
    const SearchFollower follower = g.followers[f];
    const float4 force = g.forces[follower.node], present = g.present[follower.node];
    sum.x += follower.ratio * (force.x - present.x);
    sum.y += follower.ratio * (force.y - present.y);
    sum.z += follower.ratio * (force.z - present.z);
  }
  g.forces[master] = sum;
}

// Writes the image of `now` at unit length, without its part along the vector before.
__global__ void __launch_bounds__(block) multiply(const __grid_constant__ LanczosIteration g)
{
  let_next_kernel_start();
  wait_for_kernel_before();
  const double2 size = joined_blocks(g.size);
  const auto image = static_cast<float>(size.y / (g.amplitude * sqrt(size.x)));
  float back = 0;
  if (g.size_before != nullptr)
    back = static_cast<float>(sqrt(size.x / joined_blocks(g.size_before).x));
  double along = 0;
  for (std::uint32_t n = blockIdx.x * block + threadIdx.x; n < g.nodes; n += gridDim.x * block)
  {
    const float4 f = g.forces[n], p = g.present[n], v = g.now[n], b = g.before[n];
    const float share = image * root_of(g, n);
    const float4 w = make_float4(share * (f.x - p.x) - back * b.x, share * (f.y - p.y) - back * b.y,
                                 share * (f.z - p.z) - back * b.z, 0);
    g.after[n] = w;
    along += double(w.x) * v.x + double(w.y) * v.y + double(w.z) * v.z;
  }
  along = joined_by_block(along);
  if (threadIdx.x == 0)
    g.along[blockIdx.x] = along;
}

// Takes away the part along `now`.
__global__ void __launch_bounds__(block) orthogonalise(const __grid_constant__ LanczosIteration g)
{
  let_next_kernel_start();
  wait_for_kernel_before();
  const double squared_length = joined_blocks(g.size).x;
  const auto part = static_cast<float>(joined_blocks(g.along) / squared_length);
  double2 size{ 0, 0 };
  for (std::uint32_t n = blockIdx.x * block + threadIdx.x; n < g.nodes; n += gridDim.x * block)
  {
    const float4 v = g.now[n];
    float4 w = g.after[n];
    w = make_float4(w.x - part * v.x, w.y - part * v.y, w.z - part * v.z, 0);
    g.after[n] = w;
    const double2 own{ double(w.x) * w.x + double(w.y) * w.y + double(w.z) * w.z,
                       double(root_of(g, n)) * fmax(fabs(w.x), fmax(fabs(w.y), fabs(w.z))) };
    size = joined(size, own);
  }
  size = joined_by_block(size);
  if (threadIdx.x == 0)
    g.size_next[blockIdx.x] = size;
}

__global__ void __launch_bounds__(block) list_shares(const __grid_constant__ VectorSum g)
{
  for (std::uint32_t n = blockIdx.x * block + threadIdx.x; n < g.nodes; n += gridDim.x * block)
  {
    float x = 0, y = 0, z = 0;
    for (int i = 0; i < g.vectors; ++i)
    {
      const float4 along = g.vector[i][n];
      x += g.component[i] * along.x;
      y += g.component[i] * along.y;
      z += g.component[i] * along.z;
    }
    const float share = x * x + y * y + z * z;
    if (share > g.least)
      if (const std::uint32_t at = atomicAdd(g.listed, 1u); at < 1 / g.least)
        g.list[at] = make_uint2(n, __float_as_uint(share));
  }
}

__global__ void __launch_bounds__(block) set_inverse_masses(const InverseMass* masses, std::uint32_t count, float4* u,
                                                            float4* other, float* mobility, float* of_groups)
{
  for (std::uint32_t i = blockIdx.x * block + threadIdx.x; i < count; i += gridDim.x * block)
  {
    const InverseMass mass = masses[i];
    u[mass.node].w = other[mass.node].w = mass.own;
    if (mobility != nullptr)
      mobility[mass.node] = mass.own;
    if (of_groups != nullptr)
      of_groups[mass.node] = mass.of_group;
  }
}

}  // namespace cuda

cudaError_t launch_list_shares(const VectorSum& mode, cudaStream_t stream)
{
  cuda::list_shares<<<lanczos_blocks, cuda::block, 0, stream>>>(mode);
  return cudaGetLastError();
}

cudaError_t launch_set_inverse_masses(const InverseMass* masses, std::uint32_t count, float4* u, float4* other,
                                      float* mobility, float* of_groups, cudaStream_t stream)
{
  cuda::set_inverse_masses<<<(count + cuda::block - 1) / cuda::block, cuda::block, 0, stream>>>(masses, count, u, other,
                                                                                                mobility, of_groups);
  return cudaGetLastError();
}

cudaError_t launch_displace(const LanczosIteration& iteration, cudaStream_t stream)
{
  const cudaError_t status = cuda::launch_after(cuda::displace, lanczos_blocks, cuda::block, stream, iteration);
  if (status != cudaSuccess)
    return status;
  return cuda::launch_after(cuda::move_followers, cuda::blocks_of_masters(iteration), cuda::block, stream, iteration);
}

cudaError_t launch_lanczos_product(const LanczosIteration& iteration, cudaStream_t stream)
{
  cudaError_t status = cuda::launch_after(cuda::add_forces_of_followers, cuda::blocks_of_masters(iteration),
                                          cuda::block, stream, iteration);
  for (const auto kernel : { cuda::multiply, cuda::orthogonalise })
    if (status == cudaSuccess)
      status = cuda::launch_after(kernel, lanczos_blocks, cuda::block, stream, iteration);
  return status;
}

}  // namespace frontalis
