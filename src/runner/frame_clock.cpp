#include "runner/frame_clock.hpp"

#include <algorithm>

namespace frontalis
{

void FrameClock::restart(double now, double simulated)
{
  start_ = now;
  simulated_start_ = simulated;
  factor_ = 0;
  frames_.assign(1, { now, simulated });
}

double FrameClock::behind(double now, double simulated, double limit)
{
  const double behind = simulated_start_ + (now - start_) - simulated, within = std::clamp(behind, -limit, limit);
  if (within != behind)
  {
    start_ = now;
    simulated_start_ = simulated + within;
  }
  return within;
}

double FrameClock::record_frame(double now, double simulated)
{
  constexpr double longest_pause = 60;  // [s]; what is longer is a jump, as when /clock begins
  if (now < frames_.back().first || now > frames_.back().first + longest_pause)
    frames_.clear();
  else if (now == frames_.back().first && frames_.size() > 1)
    frames_.pop_back();
  frames_.push_back({ now, simulated });
  while (frames_.size() > 2 && now - frames_[1].first > 1)
    frames_.pop_front();
  if (now > frames_.front().first)
    factor_ = (simulated - frames_.front().second) / (now - frames_.front().first);
  return factor_;
}

}  // namespace frontalis
