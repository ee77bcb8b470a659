#pragma once

#include <chrono>
#include <deque>
#include <utility>

namespace frontalis
{

/// Relates simulated time to wall time: how far the simulation is behind the wall clock, and the real-time factor over
/// the last second. The caller gives all times, wall times as time points and simulated times in seconds.
class FrameClock
{
public:
  using TimePoint = std::chrono::steady_clock::time_point;

  /// Starts again, for instance after a pause: the simulation counts as neither behind nor ahead at `now`.
  void restart(TimePoint now, double simulated);
  /// Returns by how many seconds the simulated time is behind the wall clock; negative if it is ahead. At most `limit`
  /// is returned: a simulation that is further behind need not make up for the rest.
  double behind(TimePoint now, double simulated, double limit);
  /// Records a frame and returns the real-time factor: simulated seconds divided by wall seconds since the latest
  /// recorded frame that is older than a second, or since the restart.
  double record_frame(TimePoint now, double simulated);

private:
  TimePoint start_{};           ///< wall time at which the simulation was neither behind nor ahead
  double simulated_start_ = 0;  ///< simulated time at start_ [s]
  std::deque<std::pair<TimePoint, double>> frames_;
};

}  // namespace frontalis
