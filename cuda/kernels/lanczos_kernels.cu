#include "cuda/kernels/lanczos_kernels.hpp"

namespace frontalis
{
namespace cuda
{

constexpr int block = lanczos_blocks;  // so that each thread reads the sums of one block

__device__ __forceinline__ double2 joined(const double2& a, const double2& b) { return { a.x + b.x, fmax(a.y, b.y) }; }
__device__ __forceinline__ double joined(double a, double b) { return a + b; }

/// Joins the values of all threads of a block in a fixed order. All threads receive the result.
template <class Value>
__device__ Value joined_by_block(const Value& own)
{
  __shared__ Value values[block];
  __syncthreads();
  values[threadIdx.x] = own;
  for (int half = block / 2; half > 0; half /= 2)
  {
    __syncthreads();
    if (threadIdx.x < half)
      values[threadIdx.x] = joined(values[threadIdx.x], values[threadIdx.x + half]);
  }
  __syncthreads();
  return values[0];
}

__device__ __forceinline__ float root_of(const LanczosIteration& g, std::uint32_t node)
{
  return sqrtf(g.mobility == nullptr ? g.u[node].w : g.mobility[node]);
}

__global__ void __launch_bounds__(block) displace(const __grid_constant__ LanczosIteration g)
{
  const float scale = static_cast<float>(g.amplitude / joined_by_block(g.size[threadIdx.x]).y);
  for (std::uint32_t n = blockIdx.x * block + threadIdx.x; n < g.nodes; n += gridDim.x * block)
  {
    const float4 at = g.u[n], along = g.now[n];
    const float share = scale * root_of(g, n);
    g.moved[n] = make_float4(at.x + share * along.x, at.y + share * along.y, at.z + share * along.z, at.w);
  }
}

// Writes the image of `now` at unit length, without its part along the vector before.
__global__ void __launch_bounds__(block) multiply(const __grid_constant__ LanczosIteration g)
{
  const double2 size = joined_by_block(g.size[threadIdx.x]);
  const auto image = static_cast<float>(size.y / (g.amplitude * sqrt(size.x)));
  float back = 0;
  if (g.size_before != nullptr)
    back = static_cast<float>(sqrt(size.x / joined_by_block(g.size_before[threadIdx.x]).x));
  double along = 0;
  for (std::uint32_t n = blockIdx.x * block + threadIdx.x; n < g.nodes; n += gridDim.x * block)
  {
    const float4 f = g.forces[n], p = g.present[n], v = g.now[n], b = g.before[n];
    const float share = image * root_of(g, n);
    const float4 w = make_float4(share * (f.x - p.x) - back * b.x, share * (f.y - p.y) - back * b.y,
                                 share * (f.z - p.z) - back * b.z, 0);
    g.before[n] = w;
    along += double(w.x) * v.x + double(w.y) * v.y + double(w.z) * v.z;
  }
  along = joined_by_block(along);
  if (threadIdx.x == 0)
    g.along[blockIdx.x] = along;
}

// Takes away the part along `now`.
__global__ void __launch_bounds__(block) orthogonalise(const __grid_constant__ LanczosIteration g)
{
  const double squared_length = joined_by_block(g.size[threadIdx.x]).x;
  const auto part = static_cast<float>(joined_by_block(g.along[threadIdx.x]) / squared_length);
  double2 size{ 0, 0 };
  for (std::uint32_t n = blockIdx.x * block + threadIdx.x; n < g.nodes; n += gridDim.x * block)
  {
    const float4 v = g.now[n];
    float4 w = g.before[n];
    w = make_float4(w.x - part * v.x, w.y - part * v.y, w.z - part * v.z, 0);
    g.before[n] = w;
    const double2 own{ double(w.x) * w.x + double(w.y) * w.y + double(w.z) * w.z,
                       double(root_of(g, n)) * fmax(fabs(w.x), fmax(fabs(w.y), fabs(w.z))) };
    size = joined(size, own);
  }
  size = joined_by_block(size);
  if (threadIdx.x == 0)
    g.size_next[blockIdx.x] = size;
}

}  // namespace cuda

cudaError_t launch_displace(const LanczosIteration& iteration, cudaStream_t stream)
{
  cuda::displace<<<lanczos_blocks, cuda::block, 0, stream>>>(iteration);
  return cudaGetLastError();
}

cudaError_t launch_lanczos_product(const LanczosIteration& iteration, cudaStream_t stream)
{
  cuda::multiply<<<lanczos_blocks, cuda::block, 0, stream>>>(iteration);
  cuda::orthogonalise<<<lanczos_blocks, cuda::block, 0, stream>>>(iteration);
  return cudaGetLastError();
}

}  // namespace frontalis
