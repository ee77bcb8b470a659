#include "runner/frame_clock.hpp"

namespace frontalis
{
namespace
{

double seconds(FrameClock::TimePoint from, FrameClock::TimePoint to)
{
  return std::chrono::duration<double>(to - from).count();
}

}  // namespace

void FrameClock::restart(TimePoint now, double simulated)
{
  start_ = now;
  simulated_start_ = simulated;
  frames_.assign(1, { now, simulated });
}

double FrameClock::behind(TimePoint now, double simulated, double limit)
{
  const double behind = simulated_start_ + seconds(start_, now) - simulated;
  if (behind <= limit)
    return behind;
  start_ = now;
  simulated_start_ = simulated + limit;
  return limit;
}

double FrameClock::record_frame(TimePoint now, double simulated)
{
  frames_.push_back({ now, simulated });
  while (frames_.size() > 2 && seconds(frames_[1].first, now) > 1)
    frames_.pop_front();
  const double wall = seconds(frames_.front().first, now);
  return wall > 0 ? (simulated - frames_.front().second) / wall : 0;
}

}  // namespace frontalis
