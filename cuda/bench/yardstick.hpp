#pragma once

#include <cstdint>
#include <functional>

namespace frontalis
{

/// Seconds of device time of the work that `work` queues.
double device_seconds(const std::function<void()>& work);

/// Speed of the hardware on a bare element loop, to compare the solver's figures of the same run with.
struct YardstickResult
{
  double copy_bandwidth = 0;  ///< device to device, bytes read and written per second
  double microseconds_per_step = 0;
  double updates_per_second = 0;  ///< elements per second
};

/// Measures a dense block of n^3 reduced-integration neo-Hookean voxels without other effects. Blocks of threads walk
/// along z, one thread per column of nodes, and exchange displacements and forces through shared memory. Makes at least
/// `steps` steps; median of five runs.
YardstickResult run_yardstick(std::int32_t n, int steps);

}  // namespace frontalis
