#include "launch_choice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace frontalis
{
namespace cuda
{
namespace
{

// above this, a launch a step is no longer dear and strips compute less twice
constexpr std::size_t most_brick_nodes = 600000;

constexpr std::size_t most_shared_bytes = 224 * 1024;

int processors()
{
  int count = 0;
  require(cudaDeviceGetAttribute(&count, cudaDevAttrMultiProcessorCount, 0), "asking for multiprocessors");
  return count;
}

int from_environment(const char* name, int otherwise, int least, int most)
{
  const char* const text = std::getenv(name);
  return text == nullptr ? otherwise : std::clamp(std::atoi(text), least, most);
}

// about how long a step is [us]: a turn of all multiprocessors takes a latency and a time a row of voxels (measured on
// an H200)
double brick_time(const StripSettings& strips, std::size_t count)
{
  const int rows = (strips.rows + 1) * (strips.planes + 1);
  const int beside = std::max(1, most_brick_warps / rows);
  return std::ceil(static_cast<double>(count) / (processors() * beside)) * (0.85 + 0.075 * rows * beside);
}

}  // namespace

CutChoice choose_cut(const Model& model, Effects effects)
{
  const auto nodes = static_cast<double>(model.nodes.size());
  CutChoice cut;
  cut.bricks = model.nodes.size() <= most_brick_nodes;
  if (cut.bricks)
  {
    double least = 1e300;
    for (const auto& size : { std::array<int, 2>{ { 2, 1 } }, { { 2, 2 } }, { { 3, 2 } }, { { 3, 3 } } })
    {
      const StripSettings strips{ size[0], size[1] };
      const double time = brick_time(strips, VoxelStrips::count(model, strips));
      if (time < least)
        cut.strips = strips;
      least = std::min(least, time);
    }
  }
  const int asked = from_environment("FRONTALIS_CUDA_BRICKS", -1, 0, 99);
  if (asked >= 0)
  {
    cut.bricks = asked > 0;
    cut.strips = { asked / 10, asked % 10 };
    const int rows = cut.strips.rows, planes = cut.strips.planes;
    if (cut.bricks && (rows < 1 || rows > planes + 1 || (rows + 1) * (planes + 1) > most_brick_warps))
      throw Error("FRONTALIS_CUDA_BRICKS is " + std::to_string(asked) +
                  ": allowed are 0, and rows from 1 to planes + 1 that take at most " +
                  std::to_string(most_brick_warps) + " warps, such as 33");
  }
  if (!cut.bricks)
  {
    const double warps = 3.1 * 4 * processors();
    cut.strips.rows = strip_rows(effects);
    cut.strips.planes = static_cast<int>(std::clamp(nodes / 28 / cut.strips.rows / warps, 1.0, 32.0));
    cut.strips.planes = from_environment("FRONTALIS_CUDA_PLANES", cut.strips.planes, 1, 4096);
  }
  return cut;
}

StepLaunch choose_launch(DeviceModel& device)
{
  const CutChoice& cut = device.cut();
  const auto count = static_cast<int>(device.strips());
  StepLaunch launch{ cut.bricks, cut.strips.rows, cut.strips.planes, device.effects(), 0, false, 0 };
  if (!cut.bricks)
  {
    constexpr int warps = step_block / 32;
    launch.blocks = (count + warps - 1) / warps;
    return launch;
  }
  const std::size_t forces = brick_force_bytes(launch.rows, launch.planes);
  launch.shared_bytes = forces;
  const int resident = resident_blocks(launch);
  if (resident == 0)
    require(cudaGetLastError(), "this build has no code for the device");
  launch.blocks = std::min(count, resident);
  const auto turns = static_cast<std::size_t>((count + launch.blocks - 1) / std::max(launch.blocks, 1));
  StepLaunch cached = launch;
  cached.cached = true;
  cached.shared_bytes = forces + turns * brick_bytes(launch.rows, launch.planes);
  if (device.loads().follow() || cached.shared_bytes > most_shared_bytes || resident_blocks(cached) < launch.blocks)
  {
    // the limit is the kernel's, not the launch's
    resident_blocks(launch);
    return launch;
  }
  return cached;
}

}  // namespace cuda
}  // namespace frontalis
