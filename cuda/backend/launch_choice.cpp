#include "cuda/backend/launch_choice.hpp"

#include "frontalis/error.hpp"
#include "frontalis/solver/backend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>

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
  if (text == nullptr || *text == '\0')
    return otherwise;
  int value = 0;
  const char* const end = text + std::strlen(text);
  const auto read = std::from_chars(text, end, value);
  if (read.ec != std::errc() || read.ptr != end)
    throw Error(fmt::format("{} is '{}'; it must be a whole number", name, text));
  return std::clamp(value, least, most);
}

int multiprocessors()
{
  const int all = attribute(cudaDevAttrMultiProcessorCount);
  return from_environment("FRONTALIS_CUDA_MULTIPROCESSORS", all, 1, all);
}

// Shared memory of a block that patches may use [bytes]: all of it but the kernel's array of activations.
std::size_t bytes_for_patches()
{
  const int all = attribute(cudaDevAttrMaxSharedMemoryPerBlockOptin);
  const int bytes = from_environment("FRONTALIS_CUDA_SHARED_BYTES", all, 0, all);
  const int taken = 2 * static_cast<int>(sizeof(float)) * most_muscles;
  return static_cast<std::size_t>(std::max(bytes - taken, 0));
}

// Number of patches per multiprocessor (turns) with which the largest patch is expected to fit; 0 if there is none. The
// estimate is for a curved shell or a block: the largest patch has `uneven` times the mean number of nodes,
// `with_border` times the mean number of voxels, and a halo of `halo_share` of its number of nodes.
int expected_turns(const Model& model, int processors, std::size_t bytes)
{
  constexpr double uneven = 1.35, with_border = 1.5, halo_share = 0.7;
  const double nodes = uneven * static_cast<double>(model.nodes.size()) / processors,
               voxels = with_border * static_cast<double>(model.voxels.size()) / processors;
  for (int turns = 1; turns <= most_turns; ++turns)
    if (patch_bytes(static_cast<std::size_t>(voxels / turns), static_cast<std::size_t>(halo_share * nodes / turns),
                    static_cast<std::size_t>(nodes)) < bytes)
      return turns;
  return 0;
}

}  // namespace

CutChoice choose_cut(const Model& model, Effects effects)
{
  const int processors = multiprocessors();
  CutChoice cut;
  cut.patch_bytes = bytes_for_patches();
  const int turns = need_strips(model)
                        ? 0
                        : from_environment("FRONTALIS_CUDA_PATCHES", expected_turns(model, processors, cut.patch_bytes),
                                           0, most_turns);
  cut.patches = { processors, turns };
  // Nearly all strips should run at the same time, because a second round would take as long as the first.
  cut.most_strips = static_cast<std::size_t>(strip_blocks(effects)) * (step_block / 32) * processors;
  cut.strips.rows = strip_rows(effects);
  const double planes =
      static_cast<double>(model.nodes.size()) / 28 / cut.strips.rows / (0.9 * static_cast<double>(cut.most_strips));
  const int wanted = from_environment("FRONTALIS_CUDA_PLANES", 0, 1, 4096);
  cut.most_planes = wanted > 0 ? 0 : 32;
  cut.strips.planes = wanted > 0 ? wanted : static_cast<int>(std::clamp(planes, 1.0, 32.0));
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
  launch.blocks = multiprocessors();
  resident_blocks(device.launch_with_parts());  // prepares the kernel of searches for the time step
  if (resident_blocks(launch) < launch.blocks)
    throw BackendUnavailable(fmt::format(
        "backend cuda: patches of {} bytes of shared memory do not fit a multiprocessor", launch.shared_bytes));
  return launch;
}

}  // namespace cuda
}  // namespace frontalis
