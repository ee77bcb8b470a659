#include "runner/frame_clock.hpp"

#include <gtest/gtest.h>

namespace frontalis
{
namespace
{

TEST(FrameClock, TellsHowFarTheSimulationIsBehindOrAhead)
{
  FrameClock clock;
  clock.restart(10, 3);
  EXPECT_NEAR(clock.behind(10, 3, 1), 0, 1e-6);
  EXPECT_NEAR(clock.behind(10.5, 3.2, 1), 0.3, 1e-6);
  EXPECT_NEAR(clock.behind(10.6, 3.7, 1), -0.1, 1e-6);
}

TEST(FrameClock, ForgetsDelaysBeyondTheLimit)
{
  FrameClock clock;
  clock.restart(0, 0);
  EXPECT_NEAR(clock.behind(5, 0.5, 0.1), 0.1, 1e-6);
  // from now on the simulated time 0.6 s corresponds to the wall time 5 s
  EXPECT_NEAR(clock.behind(5.05, 0.65, 0.1), 0, 1e-6);
  EXPECT_NEAR(clock.behind(5.15, 0.7, 0.1), 0.05, 1e-6);
}

TEST(FrameClock, RealTimeFactorIsThatOfTheLastSecond)
{
  FrameClock clock;
  clock.restart(0, 0);
  EXPECT_EQ(clock.record_frame(0, 0), 0);
  EXPECT_NEAR(clock.record_frame(0.5, 0.25), 0.5, 1e-6);
  // the first two seconds run at half the speed of real time, the rest at twice the speed of real time
  double factor = 0;
  for (int frame = 6; frame <= 20; ++frame)
    factor = clock.record_frame(0.1 * frame, 0.05 * frame);
  EXPECT_NEAR(factor, 0.5, 1e-6);
  for (int frame = 1; frame <= 12; ++frame)
    factor = clock.record_frame(2 + 0.1 * frame, 1 + 0.2 * frame);
  EXPECT_NEAR(factor, 2, 1e-6);
  clock.restart(4, 0);
  EXPECT_NEAR(clock.record_frame(4.1, 0.1), 1, 1e-6);
}

TEST(FrameClock, MayStandStillAndJump)
{
  FrameClock clock;
  clock.restart(100, 0);
  EXPECT_NEAR(clock.record_frame(100.5, 0.25), 0.5, 1e-6);
  // while it stands still, what is simulated counts for the time before, and the memory does not grow
  for (int frame = 0; frame < 5; ++frame)
    EXPECT_NEAR(clock.record_frame(100.5, 0.25 + 0.1 * frame), frame == 0 ? 0.5 : 0.5 + 0.2 * frame, 1e-6);
  EXPECT_NEAR(clock.behind(100.5, 0.6, 0.2), -0.1, 1e-6);
  // set back, it is waited for no longer than the limit
  EXPECT_NEAR(clock.behind(20, 0.6, 0.2), -0.2, 1e-6);
  EXPECT_NEAR(clock.behind(20.3, 0.6, 0.2), 0.1, 1e-6);
  clock.record_frame(20, 0.6);
  EXPECT_NEAR(clock.record_frame(20.5, 0.7), 0.2, 1e-6);
  // a clock that begins after the face
  clock.restart(0, 0);
  clock.record_frame(0, 0.03);
  EXPECT_EQ(clock.record_frame(1.7e9, 0.06), 0);
  EXPECT_NEAR(clock.record_frame(1.7e9 + 0.5, 0.56), 1, 1e-6);
}

}  // namespace
}  // namespace frontalis
