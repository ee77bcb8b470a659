#include "launch_choice.hpp"

#include <algorithm>
#include <cstdlib>

namespace frontalis
{
namespace cuda
{
namespace
{

constexpr int warps_a_block = step_block / 32;

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

}  // namespace

StripSettings choose_strips(const Model& model, Effects effects)
{
  constexpr double nodes_a_row = 28;
  const double schedulers = 4.0 * processors();
  const double rows_of_nodes = static_cast<double>(model.nodes.size()) / nodes_a_row;
  StripSettings settings;
  // four rows with fibres too do not fit the registers
  const int most_rows = effects == Effects::none ? 4 : 2;
  settings.rows = std::min(rows_of_nodes > 32 * schedulers ? 4 : rows_of_nodes > 12 * schedulers ? 2 : 1, most_rows);
  settings.planes = static_cast<int>(std::clamp(rows_of_nodes / settings.rows / (3.1 * schedulers), 1.0, 32.0));
  // for measuring
  settings.rows = from_environment("FRONTALIS_CUDA_ROWS", settings.rows, 1, 4);
  settings.rows = effects == Effects::all ? 2 : settings.rows == 3 ? 4 : settings.rows;
  settings.planes = from_environment("FRONTALIS_CUDA_PLANES", settings.planes, 1, 4096);
  return settings;
}

LaunchChoice choose_launch(DeviceModel& device)
{
  const int wanted = static_cast<int>((device.strips() + warps_a_block - 1) / warps_a_block);
  StepLaunch launch{ device.rows(), device.effects(), device.slot_bytes(), wanted };
  int resident = launch.slot_bytes <= most_slot_bytes ? resident_blocks(launch) : 0;
  if (resident < wanted)
  {
    launch.slot_bytes = 0;
    resident = resident_blocks(launch);
  }
  if (resident == 0)
    require(cudaGetLastError(), "this build has no code for the device");
  const bool all_at_once =
      wanted <= resident && !device.loads().follow() && from_environment("FRONTALIS_CUDA_RESIDENT", 1, 0, 1) == 1;
  if (!all_at_once)
    launch.slot_bytes = 0;
  return { launch, all_at_once };
}

}  // namespace cuda
}  // namespace frontalis
