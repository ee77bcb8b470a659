#include "cuda/backend/device_memory.hpp"
#include "frontalis/physics/materials/neo_hookean.hpp"
#include "cuda/bench/yardstick.hpp"
#include "frontalis/study/step_time.hpp"

#include <cmath>
#include <vector>

namespace frontalis
{
namespace cuda
{

constexpr int tile_x = 32, tile_y = 16;  // threads; those on the rim of a tile read nodes but do not step them

struct Block
{
  int nodes;             // along each edge
  int planes_per_block;  // planes of nodes that a block steps
  const float* u[3];
  float* next[3];
  float* v[3];
  float mu, kappa, hourglass, scale, dt, share;
};

// replaces the displacements of one voxel by its internal forces, corner by corner
__device__ __forceinline__ void bare_element(const Block& b, float (&q)[3][8])
{
  const float scale[3] = { b.scale, b.scale, b.scale };
#pragma unroll
  for (int c = 0; c < 3; ++c)
    physics::walsh_hadamard(q[c]);
  const auto k = physics::kinematics(q[0], q[1], q[2], scale);
  const auto stress = physics::stress(physics::NeoHookean<float>{ b.mu, b.kappa }, k);
#pragma unroll
  for (int c = 0; c < 3; ++c)
  {
    q[c][0] = 0;
#pragma unroll
    for (int j = 0; j < 3; ++j)
      q[c][1 << j] = b.scale * (stress.on_gradient * k.F.a[c][j] + stress.on_cofactor * k.cofactor.a[c][j]);
    q[c][3] *= b.hourglass;
    q[c][5] *= b.hourglass;
    q[c][6] *= b.hourglass;
    q[c][7] *= b.hourglass;
    physics::walsh_hadamard_transposed(q[c]);
  }
}

__global__ void __launch_bounds__(tile_x* tile_y) bare_step(const Block b)
{
  constexpr int threads = tile_x * tile_y;
  __shared__ float plane[2][3][threads];
  __shared__ float given[3][3][threads];  // forces for the neighbours: to the right, behind, behind right
  const int t = threadIdx.x, tx = t % tile_x, ty = t / tile_x;
  const int i = blockIdx.x * (tile_x - 2) + tx - 1, j = blockIdx.y * (tile_y - 2) + ty - 1;
  const int n = b.nodes, first = blockIdx.z * b.planes_per_block, last = min(first + b.planes_per_block, n);
  const bool inside = i >= 0 && j >= 0 && i < n && j < n;
  const bool voxel = i >= 0 && j >= 0 && i < n - 1 && j < n - 1 && tx < tile_x - 1 && ty < tile_y - 1;
  const bool own = inside && tx > 0 && ty > 0 && tx < tile_x - 1 && ty < tile_y - 1;
  const auto index = [&](int k) { return (static_cast<std::size_t>(k) * n + j) * n + i; };
  const auto gather = [&](const float(&q)[3][8], int upper, float(&sum)[3])
  {
    for (int c = 0; c < 3; ++c)
      for (int g = 0; g < 3; ++g)
        given[g][c][t] = q[c][upper + g + 1];
    __syncthreads();
    for (int c = 0; c < 3; ++c)
    {
      sum[c] += q[c][upper];
      if (own)
        sum[c] += given[0][c][t - 1] + given[1][c][t - tile_x] + given[2][c][t - tile_x - 1];
    }
    __syncthreads();
  };
  float here[3] = { 0, 0, 0 }, carried[3] = { 0, 0, 0 };
  for (int c = 0; c < 3; ++c)
  {
    if (inside && first > 0)
      here[c] = b.u[c][index(first - 1)];
    plane[0][c][t] = here[c];
  }
  int low = 0;
  for (int k = first - 1; k < last; ++k, low ^= 1)
  {
    float above[3];
    for (int c = 0; c < 3; ++c)
    {
      above[c] = inside && k + 1 < n ? b.u[c][index(k + 1)] : 0;
      plane[low ^ 1][c][t] = above[c];
    }
    __syncthreads();
    float q[3][8] = {};
    if (voxel && k >= 0 && k < n - 1)
    {
      for (int c = 0; c < 3; ++c)
        for (int corner = 0; corner < 8; ++corner)
          q[c][corner] = plane[low ^ (corner >> 2)][c][t + (corner & 1) + ((corner >> 1) & 1) * tile_x];
      bare_element(b, q);
    }
    float force[3] = { carried[0], carried[1], carried[2] };
    gather(q, 0, force);
    if (own && k >= first)
      for (int c = 0; c < 3; ++c)
      {
        // nodes of the face i = 0 are held
        const float velocity = i == 0 ? 0 : b.v[c][index(k)] - b.share * force[c] - (c == 2 ? 1e-4f : 0);
        b.v[c][index(k)] = velocity;
        b.next[c][index(k)] = here[c] + b.dt * velocity;
      }
    carried[0] = carried[1] = carried[2] = 0;
    gather(q, 4, carried);
    for (int c = 0; c < 3; ++c)
      here[c] = above[c];
  }
}

}  // namespace cuda

double device_seconds(const std::function<void()>& work)
{
  cudaEvent_t begin = nullptr, end = nullptr;
  cuda::require(cudaEventCreate(&begin), "making an event");
  cuda::require(cudaEventCreate(&end), "making an event");
  cuda::require(cudaEventRecord(begin), "recording an event");
  work();
  cuda::require(cudaEventRecord(end), "recording an event");
  cuda::require(cudaEventSynchronize(end), "waiting for the device");
  float milliseconds = 0;
  cuda::require(cudaEventElapsedTime(&milliseconds, begin, end), "reading a time");
  cudaEventDestroy(begin);
  cudaEventDestroy(end);
  return 1e-3 * milliseconds;
}

// median seconds of five runs
static double median_time(const std::function<void()>& run)
{
  run();  // warms up
  std::vector<double> times(5);
  for (double& time : times)
    time = device_seconds(run);
  return spread_of(times).median;
}

YardstickResult run_yardstick(std::int32_t n, int steps)
{
  using namespace cuda;
  YardstickResult result;
  {
    const std::size_t bytes = std::size_t(1) << 30;
    const DeviceArray<char> from(bytes), to(bytes);
    require(cudaMemset(from.data(), 1, bytes), "filling");
    const double time =
        median_time([&] { cudaMemcpyAsync(to.data(), from.data(), bytes, cudaMemcpyDeviceToDevice, nullptr); });
    result.copy_bandwidth = 2.0 * static_cast<double>(bytes) / time;
  }
  const std::size_t nodes = static_cast<std::size_t>(n + 1) * (n + 1) * (n + 1);
  std::vector<DeviceArray<float>> fields;
  for (int f = 0; f < 9; ++f)
  {
    fields.emplace_back(nodes);
    require(cudaMemset(fields.back().data(), 0, fields.back().bytes()), "clearing");
  }
  const double h = 1e-3, density = 1100, young = 34e3, nu = 0.49;
  const double mu = young / (2 * (1 + nu)), kappa = young / (3 * (1 - 2 * nu)), volume = h * h * h;
  Block block{};
  block.nodes = n + 1;
  block.planes_per_block = n < 200 ? 16 : 64;
  for (int c = 0; c < 3; ++c)
    block.v[c] = fields[6 + c].data();
  block.mu = static_cast<float>(mu * volume);
  block.kappa = static_cast<float>(kappa * volume);
  block.hourglass = static_cast<float>(young * volume / (48 * h * h));
  block.scale = static_cast<float>(0.25 / h);
  const double dt = 0.3 * h / std::sqrt((kappa + 4 * mu / 3) / density);
  block.dt = static_cast<float>(dt);
  block.share = static_cast<float>(dt / (density * volume));
  const dim3 grid((n + tile_x - 2) / (tile_x - 2), (n + tile_y - 2) / (tile_y - 2),
                  (n + block.planes_per_block) / block.planes_per_block);
  int present = 0;
  const double time = median_time(
      [&]
      {
        for (int s = 0; s < steps; ++s, present ^= 1)
        {
          for (int c = 0; c < 3; ++c)
          {
            block.u[c] = fields[3 * present + c].data();
            block.next[c] = fields[3 * (1 - present) + c].data();
          }
          bare_step<<<grid, tile_x * tile_y>>>(block);
        }
        require(cudaGetLastError(), "launching the yardstick");
      });
  result.microseconds_per_step = 1e6 * time / steps;
  result.updates_per_second = static_cast<double>(n) * n * n / (result.microseconds_per_step * 1e-6);
  return result;
}

}  // namespace frontalis
