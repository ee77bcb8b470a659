#include "cuda/kernels/monitor_kernel.hpp"

#include "cuda/kernels/cut_voxel.cuh"
#include "cuda/kernels/palette_voxel.cuh"
#include "frontalis/physics/element/voxel_readings.hpp"

#include <algorithm>

namespace frontalis
{
namespace cuda
{

constexpr int block = 128;

/// A voxel in the form that the monitor evaluates, with its geometry in double precision.
struct LookedVoxel : PaletteVoxel<double, Effects::general_element>
{
  const double* grid_scale;

  __device__ __forceinline__ const double* scale() const { return grid_scale; }
};

// Cut: whether voxels may be partly filled.
template <bool Cut>
__device__ PlaneMonitor read_voxel(const StepArguments& g, const MonitorVoxels& voxels, std::uint32_t index,
                                   const float4* u)
{
  const MonitorVoxel voxel = voxels.voxels[index];
  double mode[3][8];
  for (int b = 0; b < 8; ++b)
  {
    const float4 x = u[voxel.node[b]];
    mode[0][b] = x.x;
    mode[1][b] = x.y;
    mode[2][b] = x.z;
  }
  for (auto& component : mode)
    physics::walsh_hadamard(component);
  if (Cut)
  {
    const physics::TissueCentre<float> at = tissue_centre(g, voxel.palette);
    const physics::TissueCentre<double> centre{ at.x, at.y, at.z };
    for (auto& component : mode)
      physics::to_tissue_centre(centre, component);
  }
  const PaletteVoxel<double, Effects::general_element> palette = palette_voxel<double>(g, voxel.palette);
  const auto readings = physics::voxel_readings(LookedVoxel{ palette, voxels.scale }, mode);
  voxels.stiffness[index] = static_cast<float>(readings.stiffness);
  return PlaneMonitor::of_voxel(readings, static_cast<std::int32_t>(index));
}

// Each block sums its part of the voxels and nodes in a fixed order.
template <bool Cut>
__global__ void __launch_bounds__(block)
    monitor(const __grid_constant__ StepArguments g, const __grid_constant__ MonitorVoxels voxels, const float4* u,
            PlaneMonitor* parts)
{
  __shared__ PlaneMonitor sums[block];
  PlaneMonitor sum;
  const std::uint32_t first = blockIdx.x * block + threadIdx.x, stride = gridDim.x * block;
  for (std::uint32_t e = first; e < voxels.count; e += stride)
    sum.add(read_voxel<Cut>(g, voxels, e, u));
  for (std::uint32_t n = first; n < voxels.nodes; n += stride)
  {
    const double inverse_mass = u[n].w, x = g.v[0][n], y = g.v[1][n], z = g.v[2][n];
    sum.kinetic += inverse_mass > 0 ? 0.5 * (x * x + y * y + z * z) / inverse_mass : 0.0;
  }
  sums[threadIdx.x] = sum;
  for (int half = block / 2; half > 0; half /= 2)
  {
    __syncthreads();
    if (threadIdx.x < half)
      sums[threadIdx.x].add(sums[threadIdx.x + half]);
  }
  if (threadIdx.x == 0)
    parts[blockIdx.x] = sums[0];
}

// Adds the stiffness of all voxels to their nodes at one corner. A node is this corner of at most one voxel, so that
// the sum over eight launches has a fixed order.
template <bool Cut>
__global__ void __launch_bounds__(block)
    add_to_corners(const __grid_constant__ StepArguments g, const __grid_constant__ MonitorVoxels voxels, int corner)
{
  for (std::uint32_t e = blockIdx.x * block + threadIdx.x; e < voxels.count; e += gridDim.x * block)
  {
    const float factor = Cut ? corner_factors(g, voxels.voxels[e].palette).at[corner] : 1.0f;
    voxels.node_stiffness[voxels.voxels[e].node[corner]] += factor * voxels.stiffness[e];
  }
}

// Finds the stiffest voxel at the node with the highest frequency bound.
__global__ void __launch_bounds__(block)
    find_stiffest(const __grid_constant__ StepArguments g, const __grid_constant__ MonitorVoxels voxels,
                  const float4* u, StiffestVoxel* parts)
{
  __shared__ StiffestVoxel found[block];
  StiffestVoxel most;
  for (std::uint32_t e = blockIdx.x * block + threadIdx.x; e < voxels.count; e += gridDim.x * block)
  {
    StiffestVoxel own{ 0, voxels.stiffness[e], static_cast<std::int32_t>(e) };
    for (const std::uint32_t n : voxels.voxels[e].node)
    {
      const float squared = voxels.node_stiffness[n] * (g.mobility == nullptr ? u[n].w : g.mobility[n]);
      own.frequency_squared = physics::larger_or_none(own.frequency_squared, squared);
    }
    most.add(own);
  }
  found[threadIdx.x] = most;
  for (int half = block / 2; half > 0; half /= 2)
  {
    __syncthreads();
    if (threadIdx.x < half)
      found[threadIdx.x].add(found[threadIdx.x + half]);
  }
  if (threadIdx.x == 0)
    parts[blockIdx.x] = found[0];
}

__global__ void __launch_bounds__(block)
    limit_mobility(const __grid_constant__ MonitorVoxels voxels, const float* most, float found, float* mobility)
{
  // fminf returns `most` if the other number is NaN.
  for (std::uint32_t n = blockIdx.x * block + threadIdx.x; n < voxels.nodes; n += gridDim.x * block)
    mobility[n] = fminf(most[n], found / voxels.node_stiffness[n]);
}

// The bits of floats that are not negative are in the order of the floats; those of NaN are the largest.
__global__ void __launch_bounds__(block)
    find_largest_speed(const __grid_constant__ StepArguments g, std::uint32_t nodes, std::uint32_t* bits)
{
  std::uint32_t largest = 0;
  for (std::uint32_t n = 1 + blockIdx.x * block + threadIdx.x; n < nodes; n += gridDim.x * block)
  {
    const float x = g.v[0][n], y = g.v[1][n], z = g.v[2][n];
    largest = max(largest, __float_as_uint(sqrtf(x * x + y * y + z * z)) & 0x7fffffffu);
  }
  largest = largest_of_warp(largest);
  if (threadIdx.x % 32 == 0 && largest > 0)
    atomicMax(bits, largest);
}

}  // namespace cuda

namespace
{

// Sums the voxels' energies and their stiffness at nodes.
void add_up_voxels(const StepArguments& arguments, const MonitorVoxels& voxels, const float4* u, PlaneMonitor* parts,
                   cudaStream_t stream)
{
  const bool cut = arguments.centres != nullptr;
  const auto monitor = cut ? cuda::monitor<true> : cuda::monitor<false>;
  const auto add_to_corners = cut ? cuda::add_to_corners<true> : cuda::add_to_corners<false>;
  monitor<<<monitor_blocks, cuda::block, 0, stream>>>(arguments, voxels, u, parts);
  cudaMemsetAsync(voxels.node_stiffness, 0, voxels.nodes * sizeof(float), stream);
  for (int corner = 0; corner < 8; ++corner)
    add_to_corners<<<monitor_blocks, cuda::block, 0, stream>>>(arguments, voxels, corner);
}

}  // namespace

cudaError_t launch_monitor(const StepArguments& arguments, const MonitorVoxels& voxels, const float4* u,
                           PlaneMonitor* parts, StiffestVoxel* stiffest, cudaStream_t stream)
{
  add_up_voxels(arguments, voxels, u, parts, stream);
  cuda::find_stiffest<<<monitor_blocks, cuda::block, 0, stream>>>(arguments, voxels, u, stiffest);
  return cudaGetLastError();
}

cudaError_t launch_limit_mobility(const StepArguments& arguments, const MonitorVoxels& voxels, const float4* u,
                                  PlaneMonitor* parts, const float* most, float found, float* mobility,
                                  cudaStream_t stream)
{
  add_up_voxels(arguments, voxels, u, parts, stream);
  cuda::limit_mobility<<<monitor_blocks, cuda::block, 0, stream>>>(voxels, most, found, mobility);
  return cudaGetLastError();
}

cudaError_t launch_largest_speed(const StepArguments& arguments, std::uint32_t nodes, std::uint32_t* bits,
                                 cudaStream_t stream)
{
  const std::uint32_t blocks = std::min<std::uint32_t>((nodes + cuda::block - 1) / cuda::block, monitor_blocks);
  cuda::find_largest_speed<<<blocks, cuda::block, 0, stream>>>(arguments, nodes, bits);
  return cudaGetLastError();
}

}  // namespace frontalis
