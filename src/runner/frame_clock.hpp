#pragma once

#include <deque>
#include <utility>

namespace frontalis
{

/// Relates simulated time to a clock: how far the simulation is behind it, and the real-time factor over its last
/// second. The caller gives all times [s]. The clock may stand still and jump.
class FrameClock
{
public:
  /// Starts again, for instance after a pause: the simulation counts as neither behind nor ahead at `now`.
  void restart(double now, double simulated);
  /// Returns by how many seconds the simulated time is behind the clock; negative if it is ahead. The result is within
  /// `limit`: a simulation that is further behind need not make up for the rest, and one that is further ahead, because
  /// the clock was set back, need not wait for it.
  double behind(double now, double simulated, double limit);
  /// Records a frame and returns the real-time factor: simulated seconds divided by those of the clock since the latest
  /// recorded frame that is older than a second, or since the restart or a jump of the clock. If the clock stands
  /// still, what is simulated counts for the time before.
  double record_frame(double now, double simulated);

private:
  double start_ = 0;            ///< time at which the simulation was neither behind nor ahead [s]
  double simulated_start_ = 0;  ///< simulated time at start_ [s]
  double factor_ = 0;           ///< the latest real-time factor
  std::deque<std::pair<double, double>> frames_;
};

}  // namespace frontalis
