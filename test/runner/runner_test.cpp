#include "frontalis/runner/runner.hpp"

#include "block_model.hpp"
#include "frontalis/error.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <thread>

using namespace frontalis;
using namespace std::chrono_literals;

namespace
{

// a bar along x, fixed at x = 0, one muscle along it, its far end as skin
std::shared_ptr<const Model> bar()
{
  test::BlockSettings s;
  s.voxels = { { 6, 2, 2 } };
  s.damping = 500;
  Model model = test::block_model(s);
  Muscle muscle;
  muscle.name = "puller";
  test::add_muscle(model, { { 1, 0, 0 } }, muscle);
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    if (model.nodes[n][0] == 0)
      model.rigid.push_back({ static_cast<std::int32_t>(n), 0 });
  model.bones = { "jaw" };
  model.skin.vertices = { { { 6e-3, 0, 0 } }, { { 6e-3, 2e-3, 0 } }, { { 6e-3, 2e-3, 2e-3 } } };
  model.skin.triangles = { { { 0, 1, 2 } } };
  model.skin_binding.voxel = { 5, 11, 23 };
  model.skin_binding.coordinates = { { { 1, 0, 0 } }, { { 1, 1, 0 } }, { { 1, 1, 1 } } };
  model.landmarks = { "tip" };
  model.landmark_positions = { { { 6e-3, 0, 0 } } };
  model.landmark_binding.voxel = { 5 };
  model.landmark_binding.coordinates = { { { 1, 0, 0 } } };
  model.expressions.push_back({ "pull", { { 0, 0.8f } } });
  // the face frame: local x is its z
  model.to_face.rotation = { { 0, 1, 0, 0, 0, 1, 1, 0, 0 } };
  model.to_face.translation = { { 0, 0, 1 } };
  return std::make_shared<const Model>(model);
}

double tip(const Frame& frame) { return frame.skin.landmarks[0][2] - 1; }

// waits for what must come about sooner or later, on a machine of any speed; false after a minute
template <class Condition>
bool comes_about(const Condition& condition)
{
  const auto end = std::chrono::steady_clock::now() + 60s;
  while (!condition() && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(1ms);
  return condition();
}

RunnerSettings settings(Pace pace, double frame_rate = 100) { return { { Backend::cpu, 1, 0 }, pace, frame_rate }; }

}  // namespace

TEST(Runner, LockStepAdvancesExactlyAndComesBack)
{
  Runner runner(bar(), settings(Pace::lock_step), {});
  const Frame rest = runner.step(0.01);
  EXPECT_NEAR(rest.time, 0.01, 1e-12);
  EXPECT_NEAR(tip(rest), 6e-3, 1e-6);
  runner.set_expression("pull");
  runner.step(0.02);
  const Frame pulled = runner.step(0.05);
  EXPECT_NEAR(pulled.time, 0.08, 1e-12);
  EXPECT_LT(tip(pulled), 5.5e-3);
  EXPECT_FLOAT_EQ(pulled.activation[0], 0.8f);
  EXPECT_GT(pulled.monitor.internal, 0);
  // the skin's outward normal is the face's z
  EXPECT_NEAR(pulled.skin.normals[0][2], 1, 0.1);
  runner.set_expression("relax");
  runner.step(0.02);
  EXPECT_NEAR(tip(runner.step(0.2)), 6e-3, 2e-5);
}

TEST(Runner, PublishesWhatMusclesDoAndNotWhatIsAsked)
{
  Model slow = *bar();
  slow.muscles[0].rise_time = 0.1;
  Runner runner(std::make_shared<const Model>(slow), settings(Pace::lock_step), {});
  runner.set_activation({ { slow.muscles[0].name, 1.0 } });
  const float answered = runner.step(0.02).activation[0];
  EXPECT_GT(answered, 0);
  EXPECT_LT(answered, 0.2f);
}

TEST(Runner, BonesMoveInTheFaceFrame)
{
  Runner runner(bar(), settings(Pace::lock_step), {});
  // local x is the face's z, y its x: a quarter turn about the face's y axis through its origin takes z to x
  RigidTransform motion;
  motion.rotation = { { 0, 0, 1, 0, 1, 0, -1, 0, 0 } };
  motion.translation = { { 0, 2e-3, 0 } };
  runner.set_bone("jaw", motion);
  runner.step(0.3);
  const Frame frame = runner.step(0.5);  // it swings a while
  const auto& tip_now = frame.skin.landmarks[0];
  EXPECT_NEAR(tip_now[0], 1.006, 1e-3);
  EXPECT_NEAR(tip_now[1], 2e-3, 1e-3);
  EXPECT_NEAR(tip_now[2], 0, 1e-3);
  runner.reset();
  EXPECT_NEAR(tip(runner.step(0.01)), 6e-3, 1e-5);
}

TEST(Runner, RefusesBadBoneMotionsAndKeepsItsState)
{
  Runner runner(bar(), settings(Pace::lock_step), {});
  RigidTransform infinite, scaled, mirror;
  infinite.translation[1] = std::nan("");
  scaled.rotation[0] = 1.1;
  mirror.rotation[8] = -1;
  for (const RigidTransform& motion : { infinite, scaled, mirror })
    EXPECT_THROW(runner.set_bone("jaw", motion), Error);
  try
  {
    runner.set_bone("skull", {});
    FAIL();
  }
  catch (const Error& error)
  {
    EXPECT_STREQ(error.what(), "no bone is called 'skull'; the bones are jaw");
  }
  EXPECT_NEAR(tip(runner.step(0.01)), 6e-3, 1e-6);
}

TEST(Runner, LockStepIsRepeatable)
{
  std::vector<std::array<float, 3>> first;
  for (int run = 0; run < 2; ++run)
  {
    Runner runner(bar(), settings(Pace::lock_step), {});
    runner.set_activation({ { "puller", 1.0 } });
    const Frame frame = runner.step(0.03);
    if (run == 0)
      first = frame.skin.vertices;
    EXPECT_EQ(first, frame.skin.vertices);
  }
}

// how far it keeps up depends on the machine; that it never runs ahead of the clock does not
TEST(Runner, RealTimeNeverRunsAheadOfTheClock)
{
  struct Published
  {
    double simulated, wall;
  };
  std::mutex mutex;
  std::vector<Published> frames;
  const auto count = [&]
  {
    const std::lock_guard<std::mutex> lock(mutex);
    return frames.size();
  };
  {
    const auto start = std::chrono::steady_clock::now();
    Runner runner(bar(), settings(Pace::real_time, 50),
                  [&](const Frame& frame)
                  {
                    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
                    const std::lock_guard<std::mutex> lock(mutex);
                    frames.push_back({ frame.time, wall.count() });
                  });
    ASSERT_TRUE(comes_about([&] { return count() >= 25; }));
  }
  constexpr double frame = 1.0 / 50;
  for (std::size_t f = 0; f < frames.size(); ++f)
  {
    EXPECT_LT(frames[f].simulated, frames[f].wall + 1.5 * frame) << f;
    EXPECT_GE(frames[f].simulated, f == 0 ? 0 : frames[f - 1].simulated) << f;
  }
  EXPECT_GT(frames.back().simulated, 0);
}

// scaled so that a second takes a thousandth of the steps: only a machine that is hopelessly slow would not be ahead
TEST(Runner, FastestRunsAheadOfTheClock)
{
  Model scaled = *bar();
  scaled.time_scaling = 1000;
  std::atomic<double> factor{ 0 };
  Runner runner(std::make_shared<const Model>(scaled), settings(Pace::fastest),
                [&](const Frame& frame) { factor = frame.real_time_factor; });
  EXPECT_TRUE(comes_about([&] { return factor > 1.5; })) << factor;
}

TEST(Runner, PauseStopsTimeAndResetRewinds)
{
  std::atomic<double> time{ 0 };
  Runner runner(bar(), settings(Pace::fastest), [&](const Frame& frame) { time = frame.time; });
  ASSERT_TRUE(comes_about([&] { return time > 0; }));
  runner.pause(true);
  EXPECT_TRUE(runner.paused());
  // returns when the frame under way is done
  runner.switch_effect(Effect::contraction, false);
  const double then = time;
  std::this_thread::sleep_for(200ms);
  EXPECT_EQ(time, then);
  runner.switch_effect(Effect::contraction, true);
  runner.set_activation({ { "puller", 1.0 } });
  runner.reset();
  const Frame frame = runner.step(1e-3);
  EXPECT_NEAR(frame.time, 1e-3, 1e-12);
  EXPECT_FLOAT_EQ(frame.activation[0], 0.0f);
}

TEST(Runner, BadInputIsRefusedWhole)
{
  Runner runner(bar(), settings(Pace::lock_step), {});
  EXPECT_THROW(runner.set_activation({ { "nobody", 0.5 } }), Error);
  EXPECT_THROW(runner.set_activation({ { "puller", 0.5 }, { "nobody", 0.5 } }), Error);
  for (const double bad : { -0.1, 1.1, std::nan("") })
    EXPECT_THROW(runner.set_activation({ { "puller", bad } }), Error);
  EXPECT_THROW(runner.set_expression("grin"), Error);
  EXPECT_THROW(runner.step(0), Error);
  EXPECT_THROW(runner.step(std::nan("")), Error);
  EXPECT_FLOAT_EQ(runner.step(1e-3).activation[0], 0.0f);
  try
  {
    runner.set_expression("grin");
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("relax, pull"), std::string::npos);
  }
}

TEST(Runner, AStepUnderWayCanBeEnded)
{
  Runner runner(bar(), settings(Pace::lock_step), {});
  std::string told;
  std::thread caller(
      [&]
      {
        try
        {
          runner.step(1e6);
        }
        catch (const Error& error)
        {
          told = error.what();
        }
      });
  std::this_thread::sleep_for(100ms);
  runner.reset();
  caller.join();
  EXPECT_NE(told.find("ended early"), std::string::npos) << told;
  EXPECT_NEAR(runner.step(0.01).time, 0.01, 1e-12);
}

TEST(Runner, WhatAListenerThrowsEndsTheMotionOnly)
{
  std::atomic<bool> broken{ false };
  std::atomic<bool> failed{ false };
  Runner runner(bar(), settings(Pace::real_time),
                [&](const Frame& frame)
                {
                  failed = frame.failed;
                  if (broken.exchange(false))
                    throw std::runtime_error("listener is broken");
                });
  broken = true;
  EXPECT_TRUE(comes_about([&] { return failed.load(); }));
  runner.reset();
  EXPECT_TRUE(comes_about([&] { return !failed; }));
}

TEST(Runner, EffectsGoOffAndOnAgainWhileItStandsStillAndWhileItRuns)
{
  Runner still(bar(), settings(Pace::lock_step), {});
  EXPECT_EQ(names_of(still.effects()), "elasticity, contraction, rigid_nodes, output_fields");
  still.switch_effect(Effect::contraction, false);
  EXPECT_FALSE(still.effects().has(Effect::contraction));
  still.set_activation({ { "puller", 0.5 } });
  EXPECT_NEAR(tip(still.step(0.05)), 6e-3, 1e-6);
  still.switch_effect(Effect::contraction, true);
  EXPECT_LT(tip(still.step(0.05)), 5.9e-3);
  EXPECT_THROW(still.switch_effect(Effect::viscosity, false), Error);
  EXPECT_THROW(still.switch_effect(Effect::elasticity, false), Error);

  std::atomic<double> at{ 0 };
  std::atomic<int> frames{ 0 };
  Runner running(bar(), settings(Pace::fastest),
                 [&](const Frame& frame)
                 {
                   at = tip(frame);
                   ++frames;
                 });
  const auto some_frames = [&]
  {
    for (const int before = frames; frames < before + 20;)
      std::this_thread::sleep_for(1ms);
  };
  running.switch_effect(Effect::contraction, false);
  running.set_activation({ { "puller", 0.5 } });
  EXPECT_EQ(names_of(running.effects()), "elasticity, rigid_nodes, output_fields");
  some_frames();
  EXPECT_NEAR(at, 6e-3, 1e-6);
  running.switch_effect(Effect::contraction, true);
  EXPECT_FALSE(running.paused());
  some_frames();
  EXPECT_LT(at, 5.9e-3);
}

TEST(Runner, ALongStepKeepsNobodyWaiting)
{
  Runner runner(bar(), settings(Pace::lock_step), {});
  runner.step(1e-3);
  const std::string busy = "another step is under way";
  std::string ended = busy;
  std::thread stepping(
      [&]
      {
        while (ended == busy)
          try
          {
            runner.step(1e6);
          }
          catch (const Error& error)
          {
            ended = error.what();
          }
      });
  // until it is under way, a step of no length to speak of is served
  for (bool under_way = false; !under_way;)
    try
    {
      runner.step(1e-9);
      std::this_thread::sleep_for(1ms);
    }
    catch (const Error& error)
    {
      EXPECT_EQ(error.what(), busy);
      under_way = true;
    }
  runner.switch_effect(Effect::contraction, false);
  EXPECT_FALSE(runner.effects().has(Effect::contraction));
  runner.reset();
  stepping.join();
  EXPECT_EQ(ended, "the step was ended early");
  EXPECT_NEAR(runner.step(0.01).time, 0.01, 1e-12);
}

TEST(Runner, FieldsOfTheSkinAreComputedWhereSomebodyWantsThem)
{
  std::atomic<bool> listens{ false };
  RunnerSettings wanted = settings(Pace::lock_step);
  wanted.wanted_field = [&] { return listens ? std::make_optional(SkinField::strain) : std::nullopt; };
  Runner runner(bar(), wanted, {});
  runner.set_activation({ { "puller", 0.5 } });
  EXPECT_TRUE(runner.step(0.01).field.empty());
  listens = true;
  EXPECT_EQ(runner.step(0.01).field.size(), 3u);
  listens = false;
  EXPECT_TRUE(runner.step(0.01).field.empty());
}

TEST(Runner, FrameRatesThatMakeNoSenseAreRefused)
{
  for (const double rate : { 1e-3, 1e9 })
    EXPECT_THROW(Runner(bar(), settings(Pace::real_time, rate), {}), Error);
}

TEST(Runner, TimeScalingPlaysTheSameClock)
{
  auto model = std::make_shared<Model>(*bar());
  model->time_scaling = 4;
  Runner runner(model, settings(Pace::lock_step), {});
  // little: where voxels stiffen fast, steps are shorter
  runner.set_activation({ { "puller", 0.2 } });
  const Frame scaled = runner.step(0.04);
  EXPECT_NEAR(scaled.time, 0.04, 1e-12);
  // a quarter of the steps
  Runner plain(bar(), settings(Pace::lock_step), {});
  plain.set_activation({ { "puller", 0.2 } });
  EXPECT_NEAR(static_cast<double>(scaled.steps), static_cast<double>(plain.step(0.04).steps) / 4, 0.1 * scaled.steps);
}
