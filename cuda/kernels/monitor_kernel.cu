#include "cuda/kernels/monitor_kernel.hpp"

#include "frontalis/physics/assumed_strain.hpp"
#include "frontalis/physics/hourglass.hpp"
#include "frontalis/physics/selective_reduced.hpp"
#include "frontalis/physics/time_step.hpp"
#include "solver/material_laws.hpp"

namespace frontalis
{
namespace cuda
{

constexpr int block = 128;

using Kinematics = physics::Kinematics<double>;

__device__ double elastic_energy(const StepArguments& g, std::uint32_t palette,
                                 const physics::NeoHookean<double>& material, const Kinematics& k)
{
  double sum = physics::energy(material, k);
  for (std::uint32_t l = g.law_begin == nullptr ? 0 : g.law_begin[palette];
       g.law_begin != nullptr && l < g.law_begin[palette + 1]; ++l)
  {
    const LawEntry& entry = g.laws[l];
    double parameters[11];
    for (int p = 0; p < 11; ++p)
      parameters[p] = entry.parameters[p];
    visit_law(static_cast<Law>(entry.law), parameters,
              [&](const auto& law, const auto&... families)
              { sum += double(entry.weight) * physics::energy(law, k, families...); });
  }
  return sum;
}

__device__ double stiffness_now(const StepArguments& g, std::uint32_t palette, const Kinematics& k)
{
  const float4 entry = g.palette[palette];
  const physics::NeoHookean<double> material{ entry.x, entry.y };
  double sum = physics::voxel_stiffness_now(double(entry.w), material, k, g.stretch_weight, g.stretch_half_sum);
  for (std::uint32_t l = g.law_begin == nullptr ? 0 : g.law_begin[palette];
       g.law_begin != nullptr && l < g.law_begin[palette + 1]; ++l)
  {
    const LawEntry& law = g.laws[l];
    double parameters[11];
    for (int p = 0; p < 11; ++p)
      parameters[p] = law.parameters[p];
    sum += law_stiffening(static_cast<Law>(law.law), parameters, double(law.at_rest), double(law.per_tangent), k);
  }
  return sum;
}

__device__ double hourglass_energy(const StepArguments& g, std::uint32_t palette, const Kinematics& k,
                                   const double (&mode)[3][8])
{
  const double scalar = g.palette[palette].z;
  if (g.stabilisation != nullptr)
  {
    const float4 s = g.stabilisation[palette];
    const double weight[3] = { g.hourglass_weight[0], g.hourglass_weight[1], g.hourglass_weight[2] };
    return physics::hourglass_energy(physics::AssumedStrain<double>{ s.x, s.y, s.z, s.w }, scalar, weight, k.F, mode);
  }
  double sum = 0;
  for (const auto& component : mode)
    for (int m = 0; m < 8; ++m)
      if (physics::is_hourglass_mode(m))
        sum += component[m] * component[m];
  return 0.5 * scalar * sum;
}

__device__ PlaneMonitor look(const StepArguments& g, const MonitorVoxels& voxels, std::uint32_t index, const float4* u)
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
  const Kinematics k = physics::kinematics(mode[0], mode[1], mode[2], voxels.scale);
  const float4 entry = g.palette[voxel.palette];
  const auto name = static_cast<std::int32_t>(index);
  PlaneMonitor own{ 0, 0, 0, k.J, 0, name };
  double stiffness = 0;
  if (!g.selective_reduced)
  {
    own.internal = elastic_energy(g, voxel.palette, { entry.x, entry.y }, k);
    own.hourglass = hourglass_energy(g, voxel.palette, k, mode);
    stiffness = stiffness_now(g, voxel.palette, k);
  }
  else
  {
    own.internal = 0.5 * entry.y * k.dilatation * k.dilatation;
    for (int point = 0; point < 8; ++point)
    {
      double moved[3][8];
      physics::at_gauss_point(point, mode, moved);
      const Kinematics there = physics::kinematics(moved[0], moved[1], moved[2], voxels.scale);
      own.internal += 0.125 * elastic_energy(g, voxel.palette, { entry.x, 0 }, there);
      own.worst_jacobian = fmin(own.worst_jacobian, there.J);
      stiffness = physics::larger_or_none(stiffness, stiffness_now(g, voxel.palette, there));
    }
  }
  own.inverted = own.worst_jacobian <= 0 ? 1 : 0;
  voxels.stiffness[index] = static_cast<float>(stiffness);
  return own;
}

// each block takes its part of the voxels and of the nodes, in one order
__global__ void __launch_bounds__(block)
    monitor(const __grid_constant__ StepArguments g, const __grid_constant__ MonitorVoxels voxels, const float4* u,
            PlaneMonitor* parts)
{
  __shared__ PlaneMonitor sums[block];
  PlaneMonitor sum;
  const std::uint32_t first = blockIdx.x * block + threadIdx.x, stride = gridDim.x * block;
  for (std::uint32_t e = first; e < voxels.count; e += stride)
    sum.add(look(g, voxels, e, u));
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

// a node is this corner of one voxel at most, so that nothing is added in a racing order
__global__ void __launch_bounds__(block) add_to_corners(const __grid_constant__ MonitorVoxels voxels, int corner)
{
  for (std::uint32_t e = blockIdx.x * block + threadIdx.x; e < voxels.count; e += gridDim.x * block)
    voxels.node_stiffness[voxels.voxels[e].node[corner]] += voxels.stiffness[e];
}

// a voxel as stiff as the stiffest of its nodes; of those at one node the stiffest
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

}  // namespace cuda

cudaError_t launch_monitor(const StepArguments& arguments, const MonitorVoxels& voxels, const float4* u,
                           PlaneMonitor* parts, StiffestVoxel* stiffest, cudaStream_t stream)
{
  cuda::monitor<<<monitor_blocks, cuda::block, 0, stream>>>(arguments, voxels, u, parts);
  cudaMemsetAsync(voxels.node_stiffness, 0, voxels.nodes * sizeof(float), stream);
  for (int corner = 0; corner < 8; ++corner)
    cuda::add_to_corners<<<monitor_blocks, cuda::block, 0, stream>>>(voxels, corner);
  cuda::find_stiffest<<<monitor_blocks, cuda::block, 0, stream>>>(arguments, voxels, u, stiffest);
  return cudaGetLastError();
}

}  // namespace frontalis
