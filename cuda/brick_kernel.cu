#include "march.cuh"

namespace frontalis
{
namespace cuda
{

// A brick is a strip that a block of threads computes at once: each warp takes one row of voxels, forces meet in shared
// memory, and each warp then sums and steps one row of nodes. A voxel a lane, so that a step is as long as one voxel.

// all blocks wait for each other; what they wrote before is seen after
__device__ __forceinline__ void grid_barrier(std::uint32_t* counter, std::uint32_t target)
{
  __syncthreads();
  if (threadIdx.x == 0)
  {
    asm volatile("red.release.gpu.global.add.u32 [%0], 1;" ::"l"(counter) : "memory");
    std::uint32_t seen;
    do
      asm volatile("ld.relaxed.gpu.global.u32 %0, [%1];" : "=r"(seen) : "l"(counter) : "memory");
    while (static_cast<std::int32_t>(seen - target) < 0);
    asm volatile("fence.acq_rel.gpu;" ::: "memory");
  }
  __syncthreads();
}

/// What a brick is made of: in device memory, or copied to shared memory.
struct Brick
{
  std::uint32_t planes;
  const uint2* slots;
  const std::uint32_t* fibre_words;    // null without fibres
  const std::uint32_t* viscous_words;  // null where no voxel is viscous
  const std::int32_t* tasks;
};

__device__ __forceinline__ Brick brick_in_memory(const StepArguments& g, const StepLaunch& launch, std::uint32_t index)
{
  const Strip strip = g.strips[index];
  return { strip.planes, g.slots + strip.slot_begin,
           strip.fibre_begin != Strip::none ? g.fibre_words + strip.fibre_begin : nullptr,
           g.viscous_words != nullptr ? g.viscous_words + strip.slot_begin : nullptr,
           g.brick_tasks + static_cast<std::size_t>(index) * launch.rows * (launch.planes + 2) * 32 };
}

// layout of brick_bytes(): planes, whether it has fibres; slots; fibre words; tasks
__device__ __forceinline__ Brick brick_at_hand(const StepArguments& g, const StepLaunch& launch, std::uint32_t index,
                                               char* at)
{
  const auto* const head = reinterpret_cast<const std::uint32_t*>(at);
  const std::uint32_t node_planes = launch.planes + 2;
  const auto* const slots = reinterpret_cast<const uint2*>(at + 16);
  const auto* const words = reinterpret_cast<const std::uint32_t*>(slots + (launch.rows + 2) * node_planes * 32);
  return { head[0], slots, head[1] != 0 ? words : nullptr,
           g.viscous_words != nullptr ? g.viscous_words + g.strips[index].slot_begin : nullptr,
           reinterpret_cast<const std::int32_t*>(words + (launch.rows + 1) * node_planes * 32) };
}

__device__ __forceinline__ void copy_brick(const StepArguments& g, const StepLaunch& launch, std::uint32_t index,
                                           char* at)
{
  const Brick from = brick_in_memory(g, launch, index);
  auto* const head = reinterpret_cast<std::uint32_t*>(at);
  if (threadIdx.x == 0)
  {
    head[0] = from.planes;
    head[1] = from.fibre_words != nullptr;
  }
  const std::uint32_t node_planes = launch.planes + 2;
  auto* const slots = reinterpret_cast<uint2*>(at + 16);
  auto* const words = reinterpret_cast<std::uint32_t*>(slots + (launch.rows + 2) * node_planes * 32);
  auto* const tasks = reinterpret_cast<std::int32_t*>(words + (launch.rows + 1) * node_planes * 32);
  for (std::uint32_t i = threadIdx.x; i < from.planes * (launch.rows + 2) * 32; i += blockDim.x)
    slots[i] = from.slots[i];
  for (std::uint32_t i = threadIdx.x; from.fibre_words != nullptr && i < from.planes * (launch.rows + 1) * 32;
       i += blockDim.x)
    words[i] = from.fibre_words[i];
  for (std::uint32_t i = threadIdx.x; i < node_planes * launch.rows * 32; i += blockDim.x)
    tasks[i] = from.tasks[i];
}

/// Forces of a row of voxels, [voxel row][corner in z, y][component][lane].
struct BrickForces
{
  float part[4][3][32];
};

// the row of voxels of a warp: forces after the transposed transform
template <Effects With>
__device__ __forceinline__ void row_forces(const StepArguments& g, const Brick& brick, int rows, int plane, int row,
                                           const float4* u, const float* activation, bool look,
                                           std::uint32_t& frequency_bits, BrickForces& out)
{
  const int lane = threadIdx.x & 31, left = (lane + 31) & 31;
  const int at = (plane * (rows + 2) + row) * 32 + lane, above = at + (rows + 2) * 32;
  const uint2 corner[4] = { brick.slots[at], brick.slots[at + 32], brick.slots[above], brick.slots[above + 32] };
  RowForces force[2][2] = { { no_forces(), no_forces() }, { no_forces(), no_forces() } };
  if (__any_sync(whole_warp, corner[0].y != 0))
  {
    Displacement raw[4];
#pragma unroll
    for (int i = 0; i < 4; ++i)
      raw[i] = displacement(u, corner[i]);
    ElementPlace place{};
    place.palette = corner[0].y;
    if (With != Effects::none && brick.fibre_words != nullptr)
      fetch_fibre(g, brick.fibre_words[(plane * (rows + 1) + row) * 32 + lane], place);
    if (With == Effects::all && brick.viscous_words != nullptr)
      place.viscous = brick.viscous_words[at];
    RowValues value[4];
#pragma unroll
    for (int i = 0; i < 4; ++i)
      value[i] = transform_x(raw[i]);
    voxel_forces<With>(g, place, activation, value[0], value[1], value[2], value[3], look, frequency_bits, force);
  }
#pragma unroll
  for (int i = 0; i < 4; ++i)
  {
    float sum[3];
    transform_x_transposed(force[i / 2][i % 2], left, sum);
#pragma unroll
    for (int c = 0; c < 3; ++c)
      out.part[i][c][lane] = sum[c];
  }
}

// force on a node: voxels below it, then above, rows in order
__device__ __forceinline__ void sum_forces(const BrickForces* forces, int rows, int plane, int row,
                                           std::uint32_t planes, float (&force)[3])
{
  const int lane = threadIdx.x & 31;
  force[0] = force[1] = force[2] = 0;
#pragma unroll
  for (int i = 0; i < 4; ++i)
  {
    // the voxel row for which the node is corner 3 - i
    const int voxel_plane = plane - 1 + i / 2, voxel_row = row - 1 + i % 2;
    if (voxel_plane < 0 || voxel_plane + 1 >= static_cast<int>(planes))
      continue;
    const auto& part = forces[voxel_plane * (rows + 1) + voxel_row].part[3 - i];
#pragma unroll
    for (int c = 0; c < 3; ++c)
      force[c] += part[c][lane];
  }
}

__device__ __forceinline__ void step_brick_node(const StepArguments& g, std::uint32_t word, std::int32_t task,
                                                const NodeFetch& fetch, const TangentPlane& plane, const float* force,
                                                float4* next, int step)
{
  const std::uint32_t node = word & StripSlot::node_mask;
  if (g.forces_only)
  {
    if (word & StripSlot::owned)
      next[node] = make_float4(force[0], force[1], force[2], 0);
    return;
  }
  if ((word & StripSlot::updated) == 0)
    return;
  NodeState n = updated(g, node, fetch, force);
  if (task >= 0)
    slide(g, task, plane, n);
  else if (task != brick_task::none)
  {
    const float old[3] = { fetch.own.x, fetch.own.y, fetch.own.z };
    apply_task(g, g.tasks[brick_task::other - task], old, fetch.own.w, step, n);
  }
#pragma unroll
  for (int i = 0; i < 3; ++i)
    g.v[i][node] = n.v[i];
  next[node] = make_float4(n.u[0], n.u[1], n.u[2], fetch.own.w);
}

extern __shared__ char brick_memory[];

template <Effects With>
__global__ void __launch_bounds__(32 * most_brick_warps, 1)
    brick_kernel(const __grid_constant__ StepArguments g, const __grid_constant__ StepLaunch launch)
{
  __shared__ float activation[With != Effects::none ? most_muscles : 1];
  const int rows = launch.rows, warps = (launch.rows + 1) * (launch.planes + 1);
  const int lane = threadIdx.x & 31, warp = static_cast<int>(threadIdx.x) / 32;
  const int voxel_plane = warp / (rows + 1), voxel_row = warp % (rows + 1);
  const int node_plane = warp / rows, node_row = warp % rows + 1;
  auto* const forces = reinterpret_cast<BrickForces*>(brick_memory);
  char* const at_hand = brick_memory + brick_force_bytes(launch.rows, launch.planes);
  const std::size_t stride = brick_bytes(launch.rows, launch.planes);
  if (launch.cached)
  {
    char* at = at_hand;
    for (std::uint32_t b = blockIdx.x; b < g.strip_count; b += gridDim.x, at += stride)
      copy_brick(g, launch, b, at);
  }
  // neighbouring bricks use their halves in turn, so that one barrier a brick is enough
  int half = 0;
  for (std::int32_t step = g.step_begin; step < g.step_end; ++step)
  {
    const int present = (g.first + step - g.step_begin) & 1;
    const float4* const u = g.u[present];
    float4* const next = g.u[1 - present];
    const bool look = g.look != nullptr && step + 1 == g.steps;
    if (With != Effects::none)
      set_activations(g, step, activation);
    __syncthreads();
    std::uint32_t frequency_bits = 0;
    char* at = at_hand;
    for (std::uint32_t b = blockIdx.x; b < g.strip_count; b += gridDim.x, at += stride, half ^= 1)
    {
      const Brick brick = launch.cached ? brick_at_hand(g, launch, b, at) : brick_in_memory(g, launch, b);
      const bool own = node_plane < static_cast<int>(brick.planes);
      std::uint32_t word = 0;
      std::int32_t task = brick_task::none;
      if (own)
      {
        word = brick.slots[(node_plane * (rows + 2) + node_row) * 32 + lane].x;
        task = brick.tasks[(node_plane * rows + node_row - 1) * 32 + lane];
      }
      const NodeFetch fetch = fetch_node(g, u, word);
      TangentPlane plane{};
      if (task >= 0)
        plane = g.contact_planes[task];
      BrickForces* const here = forces + half * warps;
      if (voxel_plane + 1 < static_cast<int>(brick.planes))
        row_forces<With>(g, brick, rows, voxel_plane, voxel_row, u, activation, look, frequency_bits, here[warp]);
      __syncthreads();
      if (own)
      {
        float force[3];
        sum_forces(here, rows, node_plane, node_row, brick.planes, force);
        step_brick_node(g, word, task, fetch, plane, force, next, step);
      }
    }
    if (look)
    {
      const std::uint32_t largest = __reduce_max_sync(whole_warp, frequency_bits);
      if (lane == 0)
        atomicMax(g.look, largest);
    }
    if (step + 1 < g.step_end)
      grid_barrier(g.barrier, g.barrier_base + (step + 1 - g.step_begin) * gridDim.x);
  }
}

namespace
{

const void* kernel(Effects effects)
{
  return effects == Effects::none     ? reinterpret_cast<const void*>(brick_kernel<Effects::none>)
         : effects == Effects::fibres ? reinterpret_cast<const void*>(brick_kernel<Effects::fibres>)
                                      : reinterpret_cast<const void*>(brick_kernel<Effects::all>);
}

int threads(const StepLaunch& launch) { return 32 * (launch.rows + 1) * (launch.planes + 1); }

}  // namespace
}  // namespace cuda

int resident_blocks(const StepLaunch& launch)
{
  int device = 0, processors = 0, blocks = 0;
  const void* const kernel = cuda::kernel(launch.effects);
  if (cudaGetDevice(&device) != cudaSuccess ||
      cudaDeviceGetAttribute(&processors, cudaDevAttrMultiProcessorCount, device) != cudaSuccess ||
      cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize,
                           static_cast<int>(launch.shared_bytes)) != cudaSuccess ||
      cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, kernel, cuda::threads(launch), launch.shared_bytes) !=
          cudaSuccess)
    return 0;
  return processors * blocks;
}

cudaError_t launch_bricks(const StepArguments& arguments, const StepLaunch& launch, cudaStream_t stream)
{
  void* parameters[] = { const_cast<StepArguments*>(&arguments), const_cast<StepLaunch*>(&launch) };
  const void* const kernel = cuda::kernel(launch.effects);
  const dim3 grid(launch.blocks), block(cuda::threads(launch));
  if (arguments.step_end - arguments.step_begin > 1)
    return cudaLaunchCooperativeKernel(kernel, grid, block, parameters, launch.shared_bytes, stream);
  return cudaLaunchKernel(kernel, grid, block, parameters, launch.shared_bytes, stream);
}

}  // namespace frontalis
