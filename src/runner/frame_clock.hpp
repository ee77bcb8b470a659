#pragma once

#include <chrono>
#include <deque>
#include <utility>

namespace frontalis
{

/// Wall clock of a running face: how much simulated time is due, and the honest ratio of the two over the last second.
class FrameClock
{
public:
  using Clock = std::chrono::steady_clock;

  /// Starts anew, for instance after a pause: nothing is due and no ratio is known.
  void restart(double simulated);
  /// Simulated seconds due now at real time. More than `slack` behind is not caught up: the clock lets it go.
  double due(double simulated, double slack);
  /// Notes a frame at a simulated time; returns simulated over wall seconds over the last second noted.
  double note(double simulated);

private:
  Clock::time_point anchor_{};
  double anchor_simulated_ = 0;
  std::deque<std::pair<Clock::time_point, double>> notes_;
};

}  // namespace frontalis
