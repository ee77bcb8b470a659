#include "frontalis/runner/runner.hpp"

#include "frontalis/error.hpp"
#include "runner/bar_face.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <thread>

using namespace frontalis;
using namespace frontalis::test;
using namespace std::chrono_literals;

namespace
{

double tip(const Frame& frame) { return frame.skin.landmarks[0][2] - 1; }

/// Calls step() with a million seconds, in a thread of its own. The step has begun when the constructor returns.
class LongStep
{
public:
  explicit LongStep(Runner& runner)
      : thread_(
            [this, &runner]
            {
              while (error_ == busy)
                error_ = error_of(runner, 1e6);
            })
  {
    // until the long step has begun, very short steps succeed
    EXPECT_TRUE(comes_true([&] { return error_of(runner, 1e-9) == busy; }));
  }
  /// Waits for the end of the step and returns its error.
  std::string error()
  {
    thread_.join();
    return error_;
  }

private:
  static std::string error_of(Runner& runner, double seconds)
  {
    try
    {
      runner.step(seconds);
    }
    catch (const Error& error)
    {
      return error.what();
    }
    return "";
  }

  inline static const std::string busy = "another step is under way";
  std::string error_ = busy;
  std::thread thread_;
};

}  // namespace

TEST(Runner, DampingChangesWhileTheFaceRuns)
{
  Runner runner(bar(), settings(Pace::lock_step), {});
  runner.set_expression("pull");
  const double moving = tip(runner.step(0.005));
  runner.set_damping(1e8);
  EXPECT_NEAR(tip(runner.step(0.02)), moving, 5e-5) << "so much damping stops a motion";
  runner.set_damping(-1);
  EXPECT_LT(tip(runner.step(0.1)), 5.5e-3) << "with the damping of the model";
  EXPECT_THROW(runner.set_damping(std::nan("")), Error);
}

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

TEST(Runner, HandsOutNoFrameOfAStepThatGoesOn)
{
  std::vector<double> times;
  Runner runner(bar(), settings(Pace::lock_step), [&](const Frame& frame) { times.push_back(frame.time); });
  EXPECT_NEAR(runner.step(0.01, false).time, 0.01, 1e-12);
  EXPECT_TRUE(times.empty());
  runner.step(0.01);
  ASSERT_EQ(times.size(), 1u);
  EXPECT_NEAR(times[0], 0.02, 1e-12);
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
  // in the face frame, local x is z and local y is x; a quarter turn about the face frame's y axis takes z to x
  RigidTransform motion;
  motion.rotation = { { 0, 0, 1, 0, 1, 0, -1, 0, 0 } };
  motion.translation = { { 0, 2e-3, 0 } };
  runner.set_bone("jaw", motion);
  runner.step(0.3);
  const Frame frame = runner.step(0.5);  // the bar swings at first
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

TEST(Runner, PauseStopsTimeAndResetRewinds)
{
  std::atomic<double> time{ 0 };
  Runner runner(bar(), settings(Pace::fastest), [&](const Frame& frame) { time = frame.time; });
  EXPECT_TRUE(comes_true([&] { return time > 0; }));
  runner.pause(true);
  EXPECT_TRUE(runner.paused());
  runner.switch_effect(Effect::contraction, true);  // returns when the present frame is done
  const double then = time;
  std::this_thread::sleep_for(200ms);
  EXPECT_EQ(time, then);
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
  LongStep cancelled(runner);
  runner.cancel_step();
  EXPECT_EQ(cancelled.error(), "the step was ended early");
  LongStep reset(runner);
  runner.reset();
  EXPECT_EQ(reset.error(), "the step was ended early");
  EXPECT_NEAR(runner.step(0.01).time, 0.01, 1e-12);
}

// A plane of nodes is driven through the held one, which no time step can handle. The guard goes back and takes shorter
// steps within one slice of the step.
TEST(Runner, AStepIsAskedToEndWhileAnUnstableMotionIsTriedAgain)
{
  Model crushed = *bar();
  Load press;
  press.name = "press";
  press.kind = Load::Kind::displacement;
  press.value = { { -1.5e-3, 0, 0 } };
  press.ramp = 0.02;
  crushed.loads.push_back(press);
  for (const auto node : plane_of_nodes(crushed, 0, 1))
    crushed.prescribed.push_back({ node, 0 });
  int asked = 0;
  RunnerSettings wanted = settings(Pace::lock_step);
  wanted.guard = GuardSettings{ 2000, 0.5, 4, 3, 0 };
  wanted.ends_steps = [&]
  {
    ++asked;
    return false;
  };
  Frame last;
  Runner runner(std::make_shared<const Model>(crushed), wanted, [&](const Frame& frame) { last = frame; });
  EXPECT_THROW(runner.step(0.1), Error);
  ASSERT_TRUE(last.failed);
  EXPECT_GE(last.guard.rollbacks, 3);
  EXPECT_GT(last.steps, 2000);
  EXPECT_GT(asked, last.steps / 32);
}

TEST(Runner, WhatAListenerThrowsEndsTheMotionOnly)
{
  std::atomic<bool> broken{ true };
  std::atomic<bool> failed{ false };
  Runner runner(bar(), settings(Pace::real_time),
                [&](const Frame& frame)
                {
                  failed = frame.failed;
                  if (broken.exchange(false))
                    throw std::runtime_error("listener is broken");
                });
  EXPECT_TRUE(comes_true([&] { return failed.load(); }));
  runner.reset();
  EXPECT_TRUE(comes_true([&] { return !failed; }));
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
  std::atomic<double> at{ 0 }, time{ 0 };
  Runner running(bar(), settings(Pace::fastest),
                 [&](const Frame& frame)
                 {
                   at = tip(frame);
                   time = frame.time;
                 });
  running.switch_effect(Effect::contraction, false);
  running.set_activation({ { "puller", 0.5 } });
  EXPECT_EQ(names_of(running.effects()), "elasticity, rigid_nodes, output_fields");
  EXPECT_TRUE(comes_true([&, begin = time.load()] { return time > begin + 0.05; }));
  EXPECT_NEAR(at, 6e-3, 1e-6);
  running.switch_effect(Effect::contraction, true);
  EXPECT_FALSE(running.paused());
  EXPECT_TRUE(comes_true([&] { return at < 5.9e-3; }));
}

TEST(Runner, ALongStepKeepsNobodyWaiting)
{
  Runner runner(bar(), settings(Pace::lock_step), {});
  LongStep step(runner);
  runner.switch_effect(Effect::contraction, false);
  EXPECT_FALSE(runner.effects().has(Effect::contraction));
  runner.reset();
  EXPECT_EQ(step.error(), "the step was ended early");
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

TEST(Runner, AFaceWithoutFieldsOfTheSkinGoesOn)
{
  Model without = *bar();
  without.switched_off.push_back(name_of(Effect::output_fields));
  RunnerSettings wanted = settings(Pace::lock_step);
  wanted.wanted_field = [] { return SkinField::strain; };
  Runner runner(std::make_shared<const Model>(without), wanted, {});
  const Frame frame = runner.step(0.01);
  EXPECT_FALSE(frame.failed) << frame.failure;
  EXPECT_TRUE(frame.field.empty());
}

TEST(Runner, FrameRatesThatMakeNoSenseAreRefused)
{
  for (const double rate : { 1e-3, 1e9 })
    EXPECT_THROW(Runner(bar(), settings(Pace::real_time, rate), {}), Error);
}
