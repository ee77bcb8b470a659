#include "cuda/kernels/launch_after.cuh"
#include "cuda/kernels/node_tasks.cuh"

namespace frontalis
{
namespace cuda
{

constexpr int block = 128;

// In strips this kernel restricts and loads nodes after each step. In the step kernel, a warp with many such nodes
// would take several times as long as the others, and all of them would wait for it. With: effects of nodes, as an int,
// because nvcc cannot name a combination of enumerators.
template <int With>
__global__ void __launch_bounds__(block, 4) run_tasks(const __grid_constant__ StepArguments g)
{
  let_next_kernel_start();
  constexpr Effects effects = static_cast<Effects>(With);
  const std::uint32_t t = blockIdx.x * block + threadIdx.x;
  if (t >= g.task_count)
    return;
  const float4* const u = g.u[g.first];
  float4* const next = g.u[1 - g.first];
  const NodeTask task = g.tasks[t];
  wait_for_kernel_before();
  // All loads are issued at once, because memory latency dominates here.
  const std::int32_t sliding = task.of[node_sliding];
  const bool slides = has<effects, Effects::sliding> && has_only(task, node_sliding);
  SlidingFetch fetch;
  if (slides)
    fetch_sliding<effects>(g, sliding, fetch);
  const float4 before = u[task.node], now = next[task.node];
  NodeState n{ { now.x, now.y, now.z }, { g.v[0][task.node], g.v[1][task.node], g.v[2][task.node] } };
  // The inverse mass is taken from the buffer that the step has just written; the other buffer may not hold it.
  const float4 old = make_float4(before.x, before.y, before.z, now.w);
  if (slides)
    slide<effects>(g, sliding, { old, task.node, g.step_begin }, fetch, n);
  else if (has<effects, Effects::sliding> && has_only(task, node_gliding))
    glide_here<effects>(g, task.of[node_gliding], { old, task.node, g.step_begin }, n);
  else if (has_only(task, node_rigid))
    move_with_bone(g, task.of[node_rigid], { old, task.node, g.step_begin }, n);
  else
    apply_task<effects>(g, task, old, g.step_begin, n);
  next[task.node] = make_float4(n.u[0], n.u[1], n.u[2], now.w);
  for (int i = 0; i < 3; ++i)
    g.v[i][task.node] = n.v[i];
}

}  // namespace cuda

cudaError_t launch_tasks(const StepArguments& arguments, Effects effects, cudaStream_t stream)
{
  constexpr int plain = int(Effects::tasks), sliding = plain | int(Effects::sliding);
  const bool rubs = (effects & Effects::friction) == Effects::friction;
  const bool slides = (effects & Effects::sliding) == Effects::sliding;
  const auto kernel = rubs     ? cuda::run_tasks<int(of_nodes)>
                      : slides ? cuda::run_tasks<sliding>
                               : cuda::run_tasks<plain>;
  return cuda::launch_after(kernel, (arguments.task_count + cuda::block - 1) / cuda::block, cuda::block, stream,
                            arguments);
}

}  // namespace frontalis
