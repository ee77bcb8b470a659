#pragma once

#include <cstdint>

namespace frontalis
{

/// What the hardware does on the bare element loop, to be read beside the solver's own figures of the same run.
struct YardstickResult
{
  double copy_bandwidth = 0;  ///< device to device, bytes read and written a second
  double microseconds_a_step = 0;
  double updates_a_second = 0;  ///< elements a second
};

/// A dense block of n^3 reduced-integration neo-Hookean voxels, no effects: tiles of node columns walk along z, a
/// thread a column, neighbours' values and forces exchanged through shared memory; at least `steps` steps, median of
/// five.
YardstickResult run_yardstick(std::int32_t n, int steps);

}  // namespace frontalis
