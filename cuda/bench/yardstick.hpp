#pragma once

#include <cstdint>
#include <functional>

namespace frontalis
{

/// Seconds that the device needs for what `work` queues.
double device_seconds(const std::function<void()>& work);

/// Speed of the hardware on a bare element loop, for comparison with the solver's figures of the same run.
struct YardstickResult
{
  double copy_bandwidth = 0;  ///< device to device, bytes read and written per second
  double microseconds_per_step = 0;
  double updates_per_second = 0;  ///< elements per second
};

/// A dense block of n^3 reduced-integration neo-Hookean voxels without other effects. Blocks of threads walk along z,
/// one thread per column of nodes, and exchange displacements and forces through shared memory. At least `steps` steps;
/// median of five runs.
YardstickResult run_yardstick(std::int32_t n, int steps);

}  // namespace frontalis
