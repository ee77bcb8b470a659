#include "runner/frame_clock.hpp"

namespace frontalis
{
namespace
{

double seconds(FrameClock::Clock::duration d) { return std::chrono::duration<double>(d).count(); }

}  // namespace

void FrameClock::restart(double simulated)
{
  anchor_ = Clock::now();
  anchor_simulated_ = simulated;
  notes_.assign(1, { anchor_, simulated });
}

double FrameClock::due(double simulated, double slack)
{
  const auto now = Clock::now();
  const double behind = anchor_simulated_ + seconds(now - anchor_) - simulated;
  if (behind <= slack)
    return behind;
  anchor_ = now;
  anchor_simulated_ = simulated + slack;
  return slack;
}

double FrameClock::note(double simulated)
{
  const auto now = Clock::now();
  notes_.push_back({ now, simulated });
  while (notes_.size() > 2 && seconds(now - notes_[1].first) > 1)
    notes_.pop_front();
  const double wall = seconds(now - notes_.front().first);
  return wall > 0 ? (simulated - notes_.front().second) / wall : 0;
}

}  // namespace frontalis
