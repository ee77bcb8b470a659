#include "cuda/kernels/launch_after.cuh"
#include "cuda/kernels/push_nodes.cuh"

namespace frontalis
{
namespace cuda
{

__global__ void __launch_bounds__(push_block) push_nodes(const BoundPoints points, const PushTarget to)
{
  let_next_kernel_start();
  push_node(points, to, wait_for_kernel_before,
            [&](std::uint32_t p, std::uint32_t b)
            {
              const float4 at = points.coordinates[p], push = points.pushes[p];
              return corner_weight(b, at.x, at.y, at.z) * physics::Vec3<float>{ push.x, push.y, push.z };
            });
}

}  // namespace cuda

cudaError_t launch_push_nodes(const StepArguments& g, const BoundPoints& points, float factor, float* const (&v)[3],
                              cudaStream_t stream)
{
  return cuda::launch_after(cuda::push_nodes, cuda::push_blocks(points), cuda::push_block, stream, points,
                            cuda::push_target(g, factor, v));
}

}  // namespace frontalis
