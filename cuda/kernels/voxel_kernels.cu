#include "cuda/kernels/acting_load.cuh"
#include "cuda/kernels/contact_kernels.hpp"
#include "cuda/kernels/contact_points.cuh"
#include "cuda/kernels/cut_voxel.cuh"
#include "cuda/kernels/element_stress.cuh"
#include "cuda/kernels/launch_after.cuh"
#include "cuda/kernels/voxel_kernels.hpp"

namespace frontalis
{
namespace cuda
{

constexpr int block = contact_block;  // some blocks of find_added_stress() process points of contact

// Cut: whether voxels may be partly filled.
template <bool Cut>
__device__ __forceinline__ physics::Kinematics<float> kinematics_of(const StepArguments& g, const float4* u,
                                                                    const std::uint32_t* node, std::uint32_t palette)
{
  float mode[3][8];
  for (int b = 0; b < 8; ++b)
  {
    const float4 x = u[node[b]];
    mode[0][b] = x.x;
    mode[1][b] = x.y;
    mode[2][b] = x.z;
  }
  for (auto& component : mode)
    physics::walsh_hadamard(component);
  if (Cut)
  {
    const physics::TissueCentre<float> centre = tissue_centre(g, palette);
    for (auto& component : mode)
      physics::to_tissue_centre(centre, component);
  }
  return physics::kinematics(mode[0], mode[1], mode[2], g.scale);
}

// Effects of voxels that find_added_stress() computes.
inline constexpr Effects added_effects = Effects::fibres | Effects::general_element;

// Finds the stress of one added voxel per thread. WithBound: also finds what the laws add to its stiffness bound. The
// first blocks may find the forces on points of contact, which take long to load: one kernel hides more of that time
// than two kernels one after the other.
template <bool WithBound, bool Cut>
__global__ void __launch_bounds__(block) find_added_stress(const __grid_constant__ StepArguments g)
{
  let_next_kernel_start();
  if (blockIdx.x < g.contact.blocks_beside)
  {
    const std::uint32_t p = blockIdx.x * block + threadIdx.x;
    if (p < g.contact.point_count)
      put_push(g, p, g.contact.points[p], g.step_begin, wait_for_kernel_before);
    return;
  }
  __shared__ float2 activations[most_muscles];
  load_activations(g, activations);
  __syncthreads();
  const std::uint32_t v = (blockIdx.x - g.contact.blocks_beside) * block + threadIdx.x;
  if (v >= g.added_count)
    return;
  const AddedVoxel at = g.added_voxels[v];
  ElementPlace place{};
  place.palette = v + 1;
  if (g.fibres != nullptr && at.fibre_word != 0)
    fetch_fibre(g, at.fibre_word, place);
  wait_for_kernel_before();
  const auto k = kinematics_of<Cut>(g, g.u[g.first], at.node, place.palette);
  const Activations activation = activations_at(g, g.step_begin, activations);
  const ElementVoxel<added_effects> voxel = element_voxel<added_effects>(g, place, activation, 0);
  physics::Matrix3<float> P{};
  if (!g.selective_reduced)
    physics::add_laws(voxel, k, P);
  voxel.add_fibres(k, P);
  const auto& p = P.a;
  g.added_stress[v] = { make_float4(p[0][0], p[0][1], p[0][2], p[1][0]),
                        make_float4(p[1][1], p[1][2], p[2][0], p[2][1]), p[2][2],
                        WithBound ? physics::law_stiffening(voxel, k) : 0 };
}

template <bool Cut>
__global__ void __launch_bounds__(block) relax(const __grid_constant__ StepArguments g, const ViscousVoxels viscous,
                                               const float4* u, const float4* u_before, float elapsed)
{
  const std::uint32_t v = blockIdx.x * block + threadIdx.x;
  if (v >= viscous.count)
    return;
  const ViscousVoxel voxel = viscous.voxels[v];
  const PaletteVoxel<float, Effects::general_element> at{ g, voxel.palette, v, __ldg(g.palette + voxel.palette) };
  const auto k = kinematics_of<Cut>(g, u, voxel.node, voxel.palette);
  if (viscous.account == nullptr)
    return physics::relax_voxel(at, elapsed, k, [](const auto&, const auto&) {});
  const auto k_before = kinematics_of<Cut>(g, u_before, voxel.node, voxel.palette);
  double change = 0, now = 0;
  physics::relax_voxel(at, elapsed, k,
                       [&](const auto& before, const auto& after)
                       {
                         change += static_cast<double>(physics::relaxation_work(k_before, k, before, after));
                         now += static_cast<double>(along_strain(k, after));
                       });
  viscous.account[2 * static_cast<std::size_t>(v)] += change;
  viscous.account[2 * static_cast<std::size_t>(v) + 1] = now;
}

template <bool Cut>
__global__ void __launch_bounds__(block)
    fibre_work(const __grid_constant__ StepArguments g, const FibreVoxels fibres, const float4* u, int step, bool open)
{
  const std::uint32_t v = blockIdx.x * block + threadIdx.x;
  if (v >= fibres.count)
    return;
  const FibreVoxel voxel = fibres.voxels[v];
  const auto k = kinematics_of<Cut>(g, u, voxel.node, voxel.palette);
  const auto fraction = static_cast<float>((step + 1.0) / g.steps);
  double work = 0;
  for (std::uint32_t f = voxel.first; f < voxel.first + voxel.count; ++f)
  {
    const float4 fibre = g.fibres[f];
    const std::uint32_t word = g.fibre_muscle[f], muscle = word & 0x3fffffffu;
    const float begin = g.activation_begin[muscle];
    const auto now =
        physics::fibre_state(fibre_of(fibre, word, begin + fraction * (g.activation_end[muscle] - begin)), k);
    const float2 memory = fibres.memory[f];
    work += physics::fibre_work(memory.x, memory.y, now.stress, now.squared);
    fibres.memory[f] = make_float2(now.stress, now.squared);
  }
  fibres.work[v] = open ? 0 : fibres.work[v] + work;
}

__global__ void __launch_bounds__(block)
    node_work(const __grid_constant__ StepArguments g, const NodeAccount account, double damping)
{
  const std::uint32_t n = blockIdx.x * block + threadIdx.x;
  if (n >= account.nodes)
    return;
  const float4 u = g.u[g.first][n], next = g.u[1 - g.first][n];
  const double moved[3] = { double(next.x) - u.x, double(next.y) - u.y, double(next.z) - u.z };
  double damped = 0, constrained = 0;
  for (int i = 0; i < 3; ++i)
  {
    const double old = g.velocity_before[i][n], free = g.velocity_free[i][n], now = g.v[i][n];
    const double beside = moved[i] - g.dt_exact * now;
    const auto work = physics::node_work(old, free, now, beside, account.beside[3 * n + i], damping, g.kick);
    damped += work.damping;
    constrained += work.constraint;
    account.beside[3 * n + i] = beside;
  }
  const double mass = u.w > 0 ? 1.0 / double(u.w) : 0;
  account.damping[n] += mass * damped;
  account.constraint[n] += mass * constrained;
}

__global__ void __launch_bounds__(block)
    load_work(const __grid_constant__ StepArguments g, const NodeAccount account, int step)
{
  const std::uint32_t l = blockIdx.x * block + threadIdx.x;
  if (l >= account.loaded_nodes || g.load_begin == nullptr)
    return;
  const std::uint32_t n = account.loaded[l];
  double force[3], work = 0;
  surface_load(g, static_cast<std::int32_t>(l), step, force);
  for (int i = 0; i < 3; ++i)
    work += force[i] * 0.5 * (double(g.velocity_before[i][n]) + double(g.v[i][n]));
  account.load[l] += g.kick * work;
}

namespace
{

int blocks(std::uint32_t count) { return static_cast<int>((count + block - 1) / block); }

}  // namespace
}  // namespace cuda

cudaError_t launch_added_stress(const StepArguments& arguments, cudaStream_t stream)
{
  const bool with_bound = finds_bound(arguments);
  const auto kernel = arguments.centres == nullptr
                          ? (with_bound ? cuda::find_added_stress<true, false> : cuda::find_added_stress<false, false>)
                          : (with_bound ? cuda::find_added_stress<true, true> : cuda::find_added_stress<false, true>);
  return cuda::launch_after(kernel, arguments.contact.blocks_beside + cuda::blocks(arguments.added_count), cuda::block,
                            stream, arguments);
}

cudaError_t launch_relaxation(const StepArguments& arguments, const ViscousVoxels& viscous, const float4* u,
                              const float4* u_before, float elapsed, cudaStream_t stream)
{
  const auto kernel = arguments.centres == nullptr ? cuda::relax<false> : cuda::relax<true>;
  if (viscous.count > 0)
    kernel<<<cuda::blocks(viscous.count), cuda::block, 0, stream>>>(arguments, viscous, u, u_before, elapsed);
  return cudaGetLastError();
}

cudaError_t launch_fibre_work(const StepArguments& arguments, const FibreVoxels& fibres, const float4* u, int step,
                              bool open, cudaStream_t stream)
{
  const auto kernel = arguments.centres == nullptr ? cuda::fibre_work<false> : cuda::fibre_work<true>;
  if (fibres.count > 0)
    kernel<<<cuda::blocks(fibres.count), cuda::block, 0, stream>>>(arguments, fibres, u, step, open);
  return cudaGetLastError();
}

cudaError_t launch_node_account(const StepArguments& arguments, const NodeAccount& account, double damping, int step,
                                cudaStream_t stream)
{
  cuda::node_work<<<cuda::blocks(account.nodes), cuda::block, 0, stream>>>(arguments, account, damping);
  if (account.loaded_nodes > 0)
    cuda::load_work<<<cuda::blocks(account.loaded_nodes), cuda::block, 0, stream>>>(arguments, account, step);
  return cudaGetLastError();
}

}  // namespace frontalis
