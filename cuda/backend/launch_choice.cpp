#include "cuda/backend/launch_choice.hpp"

#include <algorithm>
#include <cstdlib>

namespace frontalis
{
namespace cuda
{
namespace
{

int attribute(cudaDeviceAttr which)
{
  int value = 0;
  require(cudaDeviceGetAttribute(&value, which, 0), "asking for the device's limits");
  return value;
}

int from_environment(const char* name, int otherwise, int least, int most)
{
  const char* const text = std::getenv(name);
  return text == nullptr ? otherwise : std::clamp(std::atoi(text), least, most);
}

// patches a multiprocessor; 0: its shared memory cannot hold its share of the nodes. Guessed from what patches of a
// curved shell and of a block have: at most so much more than the mean.
int turns(const Model& model, int processors)
{
  constexpr double uneven = 1.35, with_border = 1.5, halo_share = 0.7;
  // what kernels have besides
  const bool slides = !model.sliding.empty();
  const double taken = 2 * sizeof(float) * most_muscles + (slides ? 9 * 1024 : 0);
  const double bytes = attribute(cudaDevAttrMaxSharedMemoryPerBlockOptin) - taken;
  const double nodes = uneven * static_cast<double>(model.nodes.size()) / processors,
               voxels = with_border * static_cast<double>(model.voxels.size()) / processors;
  for (int turns = 1; turns <= most_turns; ++turns)
    if (patch_bytes(static_cast<std::size_t>(voxels / turns), static_cast<std::size_t>(halo_share * nodes / turns),
                    static_cast<std::size_t>(nodes), slides) < bytes)
      return turns;
  return 0;
}

}  // namespace

CutChoice choose_cut(const Model& model, Effects effects)
{
  const int processors = attribute(cudaDevAttrMultiProcessorCount);
  CutChoice cut;
  cut.patches = { processors, from_environment("FRONTALIS_CUDA_PATCHES", turns(model, processors), 0, most_turns) };
  // patches find planes within a launch
  if (cut.patches.turns > 0)
    cut.searches = 0;
  else
    cut.searches = static_cast<std::uint32_t>(
        from_environment("FRONTALIS_CUDA_SEARCHES", model.sliding.size() > small_model ? group_searches : search_group,
                         1, search_group));
  // all at once, where rows are full: what is left over for a second round would take as long as the first
  const double warps = 0.9 * strip_blocks(effects) * (step_block / 32) * processors;
  cut.strips.rows = strip_rows(effects);
  cut.strips.planes =
      static_cast<int>(std::clamp(static_cast<double>(model.nodes.size()) / 28 / cut.strips.rows / warps, 1.0, 32.0));
  cut.strips.planes = from_environment("FRONTALIS_CUDA_PLANES", cut.strips.planes, 1, 4096);
  return cut;
}

StepLaunch choose_launch(const DeviceModel& device)
{
  StepLaunch launch = device.launch();
  if (!launch.patches)
  {
    constexpr int warps = step_block / 32;
    launch.blocks = (static_cast<int>(device.strips()) + warps - 1) / warps;
    return launch;
  }
  launch.blocks = attribute(cudaDevAttrMultiProcessorCount);
  if (resident_blocks(launch) < launch.blocks)
  {
    require(cudaGetLastError(), "this build has no code for the device");
    throw Error("backend cuda: patches of " + std::to_string(launch.shared_bytes) +
                " bytes of shared memory do not fit a multiprocessor");
  }
  return launch;
}

}  // namespace cuda
}  // namespace frontalis
