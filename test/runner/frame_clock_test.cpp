#include "runner/frame_clock.hpp"

#include <gtest/gtest.h>

namespace frontalis
{
namespace
{

/// A wall time, in seconds from an arbitrary origin.
FrameClock::TimePoint at(double seconds)
{
  using Duration = FrameClock::TimePoint::duration;
  return FrameClock::TimePoint(std::chrono::duration_cast<Duration>(std::chrono::duration<double>(seconds)));
}

TEST(FrameClock, TellsHowFarTheSimulationIsBehindOrAhead)
{
  FrameClock clock;
  clock.restart(at(10), 3);
  EXPECT_NEAR(clock.behind(at(10), 3, 1), 0, 1e-6);
  EXPECT_NEAR(clock.behind(at(10.5), 3.2, 1), 0.3, 1e-6);
  EXPECT_NEAR(clock.behind(at(10.6), 3.7, 1), -0.1, 1e-6);
}

TEST(FrameClock, ForgetsDelaysBeyondTheLimit)
{
  FrameClock clock;
  clock.restart(at(0), 0);
  EXPECT_NEAR(clock.behind(at(5), 0.5, 0.1), 0.1, 1e-6);
  // from now on the simulated time 0.6 s corresponds to the wall time 5 s
  EXPECT_NEAR(clock.behind(at(5.05), 0.65, 0.1), 0, 1e-6);
  EXPECT_NEAR(clock.behind(at(5.15), 0.7, 0.1), 0.05, 1e-6);
}

TEST(FrameClock, RealTimeFactorIsThatOfTheLastSecond)
{
  FrameClock clock;
  clock.restart(at(0), 0);
  EXPECT_EQ(clock.record_frame(at(0), 0), 0);
  EXPECT_NEAR(clock.record_frame(at(0.5), 0.25), 0.5, 1e-6);
  // the first two seconds run at half the speed of real time, the rest at twice the speed of real time
  double factor = 0;
  for (int frame = 6; frame <= 20; ++frame)
    factor = clock.record_frame(at(0.1 * frame), 0.05 * frame);
  EXPECT_NEAR(factor, 0.5, 1e-6);
  for (int frame = 1; frame <= 12; ++frame)
    factor = clock.record_frame(at(2 + 0.1 * frame), 1 + 0.2 * frame);
  EXPECT_NEAR(factor, 2, 1e-6);
  clock.restart(at(4), 0);
  EXPECT_NEAR(clock.record_frame(at(4.1), 0.1), 1, 1e-6);
}

}  // namespace
}  // namespace frontalis
