#include "runner/bar_face.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <utility>
#include <vector>

using namespace frontalis;
using namespace frontalis::test;

TEST(Runner, RealTimeKeepsPaceWithTheClock)
{
  constexpr double rate = 50;
  std::mutex mutex;
  std::vector<Frame> frames;
  {
    Runner runner(fast_bar(), settings(Pace::real_time, rate),
                  [&](const Frame& frame)
                  {
                    const std::lock_guard<std::mutex> lock(mutex);
                    frames.push_back(frame);
                  });
    EXPECT_TRUE(comes_true(
        [&]
        {
          const std::lock_guard<std::mutex> lock(mutex);
          return !frames.empty() && frames.back().wall_time > 1.5 && frames.back().real_time_factor > 0.5;
        }));
  }
  for (std::size_t f = 0; f < frames.size(); ++f)
  {
    // the simulation is ahead of the clock by no more than the frame that it computes
    EXPECT_LE(frames[f].time, frames[f].wall_time + 1 / rate + 1e-6);
    EXPECT_LE(static_cast<double>(f), frames[f].wall_time * rate + 1);
    if (f > 0)
    {
      EXPECT_GE(frames[f].time, frames[f - 1].time);
    }
  }
  // A frame makes up for at most two late frames.
  EXPECT_LE(frames.back().real_time_factor, 1 + 3 / rate + 1e-6);
}

TEST(Runner, FollowsAGivenClock)
{
  constexpr double rate = 50;
  std::atomic<double> clock{ 1e9 }, time{ 0 };
  std::atomic<int> frames{ 0 };
  RunnerSettings with_clock = settings(Pace::real_time, rate);
  with_clock.clock = [&] { return clock.load(); };
  Runner runner(fast_bar(), with_clock,
                [&](const Frame& frame)
                {
                  time = frame.time;
                  ++frames;
                });
  const auto wait_for_frames = [&](int count)
  {
    const int from = frames;
    EXPECT_TRUE(comes_true([&] { return frames > from + count; }));
  };
  // it stands still with the clock, at most a frame ahead of it, and still hands out frames
  wait_for_frames(10);
  EXPECT_LE(time, 1 / rate + 1e-6);
  // and follows it, however rarely the clock tells its time
  clock = 1e9 + 0.4;
  EXPECT_TRUE(comes_true([&] { return time > 0.39; }));
  wait_for_frames(10);
  EXPECT_LE(time, 0.4 + 1 / rate + 1e-6);
  // set back, the clock does not stop it for long
  const double before = time;
  clock = 1000;
  wait_for_frames(2);
  EXPECT_EQ(time, before);
  clock = 1001;
  EXPECT_TRUE(comes_true([&] { return time > before + 0.3; }));
}

TEST(Runner, FastestRunsAheadOfTheClock)
{
  std::atomic<double> factor{ 0 };
  Runner runner(fast_bar(), settings(Pace::fastest), [&](const Frame& frame) { factor = frame.real_time_factor; });
  EXPECT_TRUE(comes_true([&] { return factor > 1.5; }));
}

TEST(Runner, TellsItsProgressBetweenFramesThatAreFarApart)
{
  std::mutex mutex;
  std::vector<std::pair<bool, double>> told;  // whether by a frame, and the time
  const auto note = [&](bool is_frame)
  {
    return [&, is_frame](const Frame& frame)
    {
      const std::lock_guard<std::mutex> lock(mutex);
      told.emplace_back(is_frame, frame.time);
    };
  };
  const auto last_is_frame = [&](bool is_frame)
  {
    return [&, is_frame]
    {
      const std::lock_guard<std::mutex> lock(mutex);
      return told.size() > 20 && told.back().first == is_frame;
    };
  };
  RunnerSettings with_progress = settings(Pace::fastest, 2);
  with_progress.on_progress = note(false);
  {
    Runner runner(fast_bar(), with_progress, note(true));
    EXPECT_TRUE(comes_true(last_is_frame(false)));
    // a face that is stopped within a frame shows where it stands
    runner.pause(true);
    EXPECT_TRUE(comes_true(last_is_frame(true)));
  }
  int between = 0;
  for (std::size_t i = 1; i < told.size(); ++i)
  {
    between += told[i].first ? 0 : 1;
    EXPECT_GE(told[i].second, told[i - 1].second);
  }
  EXPECT_GT(between, 1);
}

TEST(Runner, TimeScalingPlaysTheSameClock)
{
  auto model = std::make_shared<Model>(*bar());
  model->time_scaling = 4;
  Runner runner(model, settings(Pace::lock_step), {});
  // a small activation, because voxels that stiffen fast need shorter time steps
  runner.set_activation({ { "puller", 0.2 } });
  const Frame scaled = runner.step(0.04);
  EXPECT_NEAR(scaled.time, 0.04, 1e-12);
  Runner plain(bar(), settings(Pace::lock_step), {});
  plain.set_activation({ { "puller", 0.2 } });
  EXPECT_NEAR(static_cast<double>(scaled.steps), static_cast<double>(plain.step(0.04).steps) / 4, 0.1 * scaled.steps);
}
