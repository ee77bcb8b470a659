#include "solver/stepping/time_step_controller.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace frontalis;

namespace
{

constexpr double rest = 4e10;      // squared frequency at rest [1/s2]
constexpr double critical = 1e-5;  // [s]
constexpr double forever = 1e9;    // [s]
constexpr auto by_bound = TimeStepEstimate::element, by_model = TimeStepEstimate::assembled;
constexpr double unlimited = std::numeric_limits<double>::infinity();

BackendTraits traits()
{
  BackendTraits backend;
  backend.most_steps_per_plan = 100;
  backend.seconds_per_plan = 9e-4;
  return backend;
}

TimeStepController::Choice choose(const TimeStepController& controller)
{
  return controller.choose(forever, unlimited, unlimited, traits());
}

bool is_calm(const TimeStepController& controller)
{
  const auto choice = choose(controller);
  return !choice.bound_every_step && !choice.bound_awaited && choice.steps > 32;
}

bool is_cautious(const TimeStepController& controller)
{
  const auto choice = choose(controller);
  const double step = 0.55 * 2 / std::sqrt(controller.state().measured);
  return choice.bound_every_step && choice.bound_awaited && choice.steps == 8 && choice.dt <= 1.000001 * step;
}

// Number of steps at rest until the controller is no longer cautious.
int steps_until_calm(TimeStepController& controller)
{
  int steps = 0;
  for (; !is_calm(controller) && steps < 10000; ++steps)
    controller.observe(rest, 0, 1);
  return steps;
}

}  // namespace

TEST(TimeStepController, takes_a_share_of_the_critical_step_or_a_fixed_one)
{
  EXPECT_DOUBLE_EQ(TimeStepController(rest, by_bound, 0.9, 0).safe_step(), 0.9 * critical);
  TimeStepController fixed(rest, by_bound, 0.9, 0.99 * critical);
  EXPECT_DOUBLE_EQ(fixed.safe_step(), 0.99 * critical);
  fixed.observe(4 * rest, 0, 1);
  EXPECT_DOUBLE_EQ(fixed.safe_step(), critical / 2) << "no longer than critical";
  for (const double refused : { 1.01 * critical, -critical, std::nan("") })
    EXPECT_THROW(TimeStepController(rest, by_bound, 0.9, refused), Error);
}

TEST(TimeStepController, divides_a_motion_into_equal_steps_that_end_with_it)
{
  const TimeStepController controller(rest, by_bound, 0.9, 0);
  for (const double seconds : { 1e-7, 8.9e-6, 9e-6, 9.1e-6, 5e-4, 1.7e-3 })
  {
    double left = seconds;
    int plans = 0;
    for (bool ended = false; !ended; ++plans)
    {
      const auto choice = controller.choose(left, unlimited, unlimited, traits());
      EXPECT_LE(choice.dt, 0.9 * critical * (1 + 1e-8));
      EXPECT_LE(choice.steps, 100);
      left -= choice.steps * choice.dt;
      ended = choice.reaches_end;
      EXPECT_EQ(ended, left < 1e-12 * seconds) << seconds;
    }
    EXPECT_EQ(plans, seconds > 1e-3 ? 2 : 1) << seconds;
  }
  EXPECT_EQ(controller.choose(9e-6, unlimited, unlimited, traits()).steps, 1) << "a rounding error costs no step";
}

TEST(TimeStepController, plans_last_as_long_as_the_backend_likes)
{
  const TimeStepController controller(rest, by_bound, 0.9, 0);
  BackendTraits backend;
  EXPECT_EQ(controller.choose(forever, unlimited, unlimited, backend).steps, 32);
  backend.most_steps_per_plan = 128;
  for (const double seconds : { 1e-6, 4.5e-4, 1.0 })
  {
    backend.seconds_per_plan = seconds;
    const int wanted = static_cast<int>(std::min(std::max(seconds / controller.safe_step(), 32.0), 128.0));
    EXPECT_EQ(controller.choose(forever, unlimited, unlimited, backend).steps, wanted);
  }
}

TEST(TimeStepController, plans_are_no_longer_than_allowed)
{
  const TimeStepController controller(rest, by_bound, 0.9, 0);
  const double dt = controller.safe_step();
  for (const auto& [longest, steps] : { std::pair<double, int>{ 1, 100 }, { 20.5 * dt, 20 }, { 0.1 * dt, 1 } })
    EXPECT_EQ(controller.choose(forever, unlimited, longest, traits()).steps, steps);
}

TEST(TimeStepController, cautious_plans_are_no_longer_than_allowed_either)
{
  TimeStepController controller(rest, by_bound, 0.9, 0);
  controller.bone_jumped();
  const double dt = choose(controller).dt;
  for (const auto& [longest, steps] : { std::pair<double, int>{ 1, 8 }, { 2.5 * dt, 2 }, { 0.1 * dt, 1 } })
    EXPECT_EQ(controller.choose(forever, unlimited, longest, traits()).steps, steps);
}

TEST(TimeStepController, is_cautious_for_a_time_after_a_jump_of_a_bone)
{
  constexpr double slow = 4e6;  // its critical step is 1 ms
  TimeStepController controller(slow, by_bound, 0.9, 0);
  controller.bone_jumped();
  int steps = 0;
  for (; choose(controller).bound_every_step && steps < 1000; ++steps)
    controller.observe(slow, 0, 1);
  EXPECT_EQ(steps, 18) << "10 ms in steps of 0.55 of the critical one";
}

TEST(TimeStepController, no_node_moves_far_in_a_step)
{
  TimeStepController controller(rest, by_bound, 0.9, 0);
  const double longest = 0.9 * critical;
  for (const auto& [way, dt] : { std::pair<double, double>{ 0.1, longest }, { 0.14, longest }, { 0.3, longest / 2 } })
  {
    controller.observe(rest, way / longest, 32);
    EXPECT_NEAR(controller.safe_step(), dt, 1e-6 * longest) << way << " edges in a step";
    EXPECT_NEAR(choose(controller).dt, dt, 1e-6 * longest);
    EXPECT_TRUE(choose(controller).bound_awaited) << "speeds may grow";
  }
  EXPECT_FALSE(choose(controller).bound_every_step);
  controller.displacements_set(rest);
  EXPECT_NEAR(controller.safe_step(), longest / 2, 1e-6 * longest) << "velocities stay";
  controller.slow_down(0.5);
  EXPECT_NEAR(controller.safe_step(), longest / 4, 1e-6 * longest);
  controller.slow_down(1);
  controller.velocities_set(150 / longest);
  EXPECT_NEAR(controller.safe_step(), longest / 10, 1e-6 * longest) << "what is flung away does not stop the others";
  controller.reset();
  controller.velocities_set(0.05 / longest);
  EXPECT_TRUE(is_calm(controller));
}

TEST(TimeStepController, follows_what_stiffens_at_once_and_what_softens_slowly)
{
  TimeStepController controller(rest, by_bound, 0.9, 0);
  controller.observe(1.05 * rest, 0, 32);
  EXPECT_DOUBLE_EQ(controller.safe_step(), 0.9 * critical / std::sqrt(1.05));
  EXPECT_TRUE(is_calm(controller));
  controller.observe(2 * rest, 0, 32);
  EXPECT_DOUBLE_EQ(controller.safe_step(), 0.9 * critical / std::sqrt(2.0));
  controller.observe(1.2 * rest, 0, 32);
  EXPECT_DOUBLE_EQ(controller.state().measured, 0.95 * 2 * rest);
  for (int plan = 0; plan < 100; ++plan)
    controller.observe(0.5 * rest, 0, 32);
  EXPECT_DOUBLE_EQ(controller.safe_step(), 0.9 * critical) << "never longer than at rest";
}

TEST(TimeStepController, is_cautious_after_signs_of_fast_change)
{
  TimeStepController stiffened(rest, by_bound, 0.9, 0);
  stiffened.observe(1.09 * rest, 0, 32);
  EXPECT_TRUE(is_calm(stiffened));
  EXPECT_GT(1.21 * rest, stiffened.alarming());
  stiffened.observe(1.21 * rest, 0, 32);
  EXPECT_TRUE(is_cautious(stiffened));
  EXPECT_EQ(steps_until_calm(stiffened), 128);

  TimeStepController switched(rest, by_bound, 0.9, 0);
  EXPECT_FALSE(switched.muscles_switched({ 0, 0.5f }, { 0.29f, 0.25f }));
  EXPECT_TRUE(is_calm(switched));
  EXPECT_TRUE(switched.muscles_switched({ 0, 0.5f }, { 0, 0.1f }));
  EXPECT_TRUE(is_cautious(switched));
  EXPECT_EQ(steps_until_calm(switched), 48);

  TimeStepController jumped(rest, by_bound, 0.9, 0);
  jumped.bone_jumped();
  EXPECT_TRUE(is_cautious(jumped));
  EXPECT_FALSE(jumped.muscles_switched({ 0 }, { 0 }));
  jumped.observe(1.2 * rest, 0, 900);
  EXPECT_EQ(steps_until_calm(jumped), 128) << "what lasts longer counts";

  TimeStepController set(rest, by_bound, 0.9, 0);
  set.displacements_set(3 * rest);
  EXPECT_DOUBLE_EQ(set.safe_step(), 0.9 * critical / std::sqrt(3.0));
  EXPECT_TRUE(is_cautious(set));
  set.displacements_set(std::nan(""));
  EXPECT_DOUBLE_EQ(set.safe_step(), 0.9 * critical);
}

TEST(TimeStepController, takes_shorter_steps_while_stiffened_tissue_vibrates)
{
  TimeStepController controller(rest, by_bound, 0.9, 0);
  // A contraction slowly makes the model five times as stiff.
  for (double squared = rest; squared < 5 * rest; squared *= 1.03)
    controller.observe(squared, 0, 32);
  EXPECT_TRUE(is_calm(controller));
  const double squared = controller.state().measured;
  controller.observe(0.9 * squared, 0, 32);
  const auto choice = choose(controller);
  EXPECT_FALSE(choice.bound_every_step);
  EXPECT_TRUE(choice.bound_awaited);
  EXPECT_EQ(choice.steps, 32);
  EXPECT_LE(choice.dt, (1 + 1e-8) * 0.55 * 2 / std::sqrt(0.95 * squared));
  for (int step = 0; step < 256; ++step)
    controller.observe(0.9 * squared, 0, 1);
  EXPECT_TRUE(is_calm(controller));
  // Near the stiffness at rest, changes of the same relative size do not count as a vibration.
  TimeStepController soft(rest, by_bound, 0.9, 0);
  for (const double share : { 1.0, 0.9, 1.0, 0.9 })
    soft.observe(share * rest, 0, 32);
  EXPECT_TRUE(is_calm(soft));
}

TEST(TimeStepController, looks_at_every_step_where_bones_limit_it)
{
  const TimeStepController controller(rest, by_bound, 0.9, 0);
  const auto choice = controller.choose(forever, 1e-6, unlimited, traits());
  EXPECT_NEAR(choice.dt, 1e-6, 1e-12);
  EXPECT_TRUE(choice.bound_every_step);
  EXPECT_EQ(choice.steps, 8);
  EXPECT_FALSE(controller.choose(forever, 0.91 * critical, unlimited, traits()).bound_every_step);
}

TEST(TimeStepController, slows_down_whatever_it_chooses)
{
  TimeStepController controller(rest, by_bound, 0.9, 0);
  for (const bool cautious : { false, true })
  {
    if (cautious)
      controller.bone_jumped();
    const double whole = choose(controller).dt;
    controller.slow_down(0.25);
    EXPECT_NEAR(choose(controller).dt / whole, 0.25, 1e-6);
    controller.slow_down(1);
  }
  for (const double refused : { 0.0, 1.5, std::nan("") })
    EXPECT_THROW(controller.slow_down(refused), Error);
}

TEST(TimeStepController, needs_less_caution_where_searches_have_a_margin)
{
  TimeStepController controller(rest, by_model, 0.9, 0);
  controller.renew_assembled({}, false, [](const auto&) { return 0.08 * rest; });
  controller.observe(0.13 * rest, 0, 10);
  EXPECT_TRUE(choose(controller).bound_every_step);
  EXPECT_NEAR(choose(controller).dt, 0.62 * controller.critical_step_at(0.13 * rest), 1e-6 * critical);
  int steps = 0;
  for (; choose(controller).bound_every_step && steps < 100; ++steps)
    controller.observe(0.13 * rest, 0, 1);
  EXPECT_EQ(steps, 32);
}

TEST(TimeStepController, a_kept_state_knows_the_steps_that_growth_has_cost)
{
  TimeStepController one(rest, by_model, 0.9, 0), other(rest, by_model, 0.9, 0);
  int searches = 0;
  const auto search = [&searches](const auto&)
  {
    ++searches;
    return 0.08 * rest;
  };
  one.renew_assembled({}, false, search);
  one.observe(0.13 * rest, 0, 1);
  one.observe(0.13 * rest, 0, 100);  // loses 0.164 of each step
  other.restore(one.state());
  for (TimeStepController* controller : { &one, &other })
  {
    controller->renew_assembled({}, false, search);
    controller->observe(0.13 * rest, 0, 50);
    controller->renew_assembled({}, false, search);
  }
  EXPECT_EQ(searches, 3);
}

TEST(TimeStepController, goes_on_from_a_kept_state)
{
  TimeStepController one(rest, by_bound, 0.9, 0), other(rest, by_bound, 0.9, 0);
  one.observe(5 * rest, 0, 32);
  one.slow_down(0.5);
  other.restore(one.state());
  EXPECT_DOUBLE_EQ(other.safe_step(), 2 * one.safe_step()) << "the share is not the motion's";
  for (const double share : { 6.0, 4.0, 4.5, 3.0 })
  {
    one.observe(share * rest, 0, 100);
    other.observe(share * rest, 0, 100);
    EXPECT_EQ(choose(one).steps, choose(other).steps);
    EXPECT_EQ(one.state().measured, other.state().measured);
  }
  one.slow_down(1);
  one.reset();
  EXPECT_TRUE(is_calm(one));
  EXPECT_DOUBLE_EQ(one.safe_step(), 0.9 * critical);
}

TEST(TimeStepController, follows_the_growth_since_a_search_where_the_assembled_model_sets_the_step)
{
  TimeStepController controller(rest, by_model, 0.9, 0);
  EXPECT_DOUBLE_EQ(controller.safe_step(), 0.9 * critical) << "from the bound at rest, before anything is found";
  controller.observe(3 * rest, 0, 10);
  EXPECT_DOUBLE_EQ(controller.safe_step(), 0.9 * critical / std::sqrt(3.0));
  controller.reset();
  controller.renew_assembled({}, false, [](const auto&) { return 0.08 * rest; });
  EXPECT_NEAR(controller.critical_step_at(0), critical / std::sqrt(0.1), 1e-9 * critical);
  EXPECT_NEAR(controller.alarming(), 0.11 * rest, 1e-9 * rest);
  controller.observe(0.1 * rest, 0, 10);
  EXPECT_FALSE(choose(controller).bound_every_step);
  EXPECT_TRUE(choose(controller).bound_awaited) << "while tissue may still be stiffening";
  EXPECT_LT(choose(controller).steps, 100) << "until the next search";
  EXPECT_NEAR(controller.safe_step(), 0.9 * critical / std::sqrt(0.11), 1e-9 * critical);
  controller.observe(0.13 * rest, 0, 10);
  EXPECT_TRUE(choose(controller).bound_every_step) << "though this is an eighth of the bound at rest";
  for (int plan = 0; plan < 20; ++plan)
    controller.observe(0, 0, 10);
  EXPECT_NEAR(controller.safe_step(), 0.9 * critical / std::sqrt(0.143), 1e-9 * critical) << "until the next search";
  controller.renew_assembled({}, false, [](const auto&) { return 0.08 * rest; });
  EXPECT_NEAR(controller.safe_step(), 0.9 * critical / std::sqrt(0.1), 1e-9 * critical) << "it has shortened the step";
  for (int plan = 0; plan < 30; ++plan)
    controller.observe(0, 0, 10);
  controller.renew_assembled({}, false, [](const auto&) { return 0.08 * rest; });
  EXPECT_NEAR(controller.safe_step(), 0.9 * critical / std::sqrt(0.088), 1e-9 * critical) << "the model is steady";
  controller.set_bound_at_rest(2 * rest);
  EXPECT_DOUBLE_EQ(controller.safe_step(), 0.9 * critical / std::sqrt(2.0)) << "effects were switched";
  for (const double bad : { HUGE_VAL, std::nan(""), 0.0 })
  {
    controller.reset();
    controller.renew_assembled({}, false, [&](const auto&) { return bad; });
    EXPECT_LE(controller.safe_step(), 0.9 * critical / std::sqrt(2.0)) << bad;
    EXPECT_GE(controller.safe_step(), 0.9 * critical / std::sqrt(2.2)) << bad;
  }
}
