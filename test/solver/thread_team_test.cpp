// The threads of the CPU backend, and how many of them work while other programs need their cores.

#include "solver/cpu/team_size.hpp"
#include "solver/cpu/thread_team.hpp"

#include "effect_scene.hpp"
#include "nodal_vectors.hpp"

#include <algorithm>
#include <atomic>
#include <functional>
#include <thread>
#include <vector>

namespace frontalis
{
namespace
{

using test::Vectors;

TEST(ThreadTeam, as_many_threads_work_as_it_is_told)
{
  ThreadTeam team(4);
  for (const int size : { 4, 1, 3, 2, 4 })
  {
    team.resize(size);
    EXPECT_EQ(team.size(), size);
    for (int repetition = 0; repetition < 20; ++repetition)
    {
      std::vector<int> before(4, 0), after(4, 0);
      std::atomic<int> sum{ 0 };
      team.run(
          [&](int thread)
          {
            before[thread] = 1;
            sum += 1;
            team.barrier();
            after[thread] = sum;
          });
      for (int thread = 0; thread < 4; ++thread)
      {
        EXPECT_EQ(before[thread], thread < size ? 1 : 0);
        EXPECT_EQ(after[thread], thread < size ? size : 0) << "a thread passed the barrier before the others came";
      }
    }
  }
  team.resize(0);
  EXPECT_EQ(team.size(), 1);
  team.resize(9);
  EXPECT_EQ(team.size(), 4);
}

// Threads that have not worked in the former task may wake while the next one begins.
TEST(ThreadTeam, sizes_may_change_between_all_tasks)
{
  ThreadTeam team(4);
  for (int task = 0; task < 3000; ++task)
  {
    team.resize(1 + task * 7 % 4);
    std::atomic<int> sum{ 0 };
    team.run(
        [&](int)
        {
          sum += 1;
          team.barrier();
          sum += 1;
        });
    ASSERT_EQ(sum, 2 * team.size()) << task;
  }
}

/// A machine whose cores other programs may use. Times are made up.
struct Machine
{
  std::function<double(int)> rate;  ///< steps per second of a number of threads
  std::function<int(int)> held;     ///< how many of them are kept from running for half of the time

  /// Lets the team work for a time. Returns the share of it in which another number worked than at its end.
  double work(TeamSize& team, double seconds) const
  {
    constexpr double piece = 0.01;
    std::vector<double> worked(static_cast<std::size_t>(team.most()) + 1, 0);
    for (double now = 0; now < seconds; now += piece)
    {
      const int threads = team.working();
      std::vector<double> ran(static_cast<std::size_t>(threads), piece);
      for (int thread = 0; thread < held(threads); ++thread)
        ran[static_cast<std::size_t>(thread)] = piece / 2;
      worked[static_cast<std::size_t>(threads)] += piece;
      team.add(static_cast<int>(piece * rate(threads)), piece, ran);
    }
    return 1 - worked[static_cast<std::size_t>(team.working())] / seconds;
  }
};

const Machine idle{ [](int threads) { return 1000.0 * threads; }, [](int) { return 0; } };
// another program uses one of eight cores
const Machine shared{ [](int threads) { return threads == 8 ? 4000.0 : 1000.0 * threads; },
                      [](int threads) { return threads == 8 ? 1 : 0; } };

TEST(TeamSize, all_threads_work_on_an_idle_machine)
{
  TeamSize team(8);
  EXPECT_LT(idle.work(team, 100), 1e-9);
  EXPECT_EQ(team.working(), 8);
}

TEST(TeamSize, a_thread_that_delays_the_others_stops_working_until_its_core_is_free)
{
  TeamSize team(8);
  const double otherwise = shared.work(team, 60);
  EXPECT_EQ(team.working(), 7);
  EXPECT_LT(otherwise, 0.03) << "trials take time";
  idle.work(team, 20);
  EXPECT_EQ(team.working(), 8);
}

TEST(TeamSize, threads_that_help_although_they_are_held_go_on)
{
  const Machine helpful{ [](int threads) { return 100.0 * (10 + threads); }, [](int threads) { return threads / 2; } };
  TeamSize team(8);
  EXPECT_LT(helpful.work(team, 60), 0.03);
  EXPECT_EQ(team.working(), 8);
}

TEST(TeamSize, a_limit_of_processor_time_is_found)
{
  // threads that may use half of the eight cores, as in a container
  const Machine limited{ [](int threads) { return threads <= 4 ? 1000.0 * threads : 2000.0; },
                         [](int threads) { return threads <= 4 ? 0 : threads; } };
  TeamSize team(8);
  EXPECT_LT(limited.work(team, 60), 0.03);
  EXPECT_EQ(team.working(), 4);
}

TEST(TeamSize, one_thread_remains_if_all_are_held)
{
  const Machine crowded{ [](int threads) { return 1000.0 / threads; }, [](int threads) { return threads; } };
  TeamSize team(8);
  crowded.work(team, 20);
  EXPECT_EQ(team.working(), 1);
  TeamSize single(1);
  crowded.work(single, 20);
  EXPECT_EQ(single.working(), 1);
}

// Whether threads are held here depends on the machine; the motion must not.
TEST(CpuSolver, other_programs_do_not_change_a_bit)
{
  const Model model = test::scene_of(test::but_friction);
  const auto moved = [&](int threads)
  {
    const auto solver = make_solver(std::make_shared<const Model>(model), { "cpu", threads });
    Controls target = solver->controls();
    std::fill(target.activation.begin(), target.activation.end(), 0.5F);
    solver->advance(0.4, target);
    Vectors displacements;
    solver->displacements(displacements);
    return displacements;
  };
  const Vectors expected = moved(1);
  std::atomic<bool> ended{ false };
  std::vector<std::thread> others;
  for (unsigned core = 0; core < std::max(1U, std::thread::hardware_concurrency()); ++core)
    others.emplace_back(
        [&]
        {
          while (!ended)
          {
          }
        });
  const Vectors found = moved(3);
  ended = true;
  for (std::thread& other : others)
    other.join();
  EXPECT_EQ(found, expected);
}

}  // namespace
}  // namespace frontalis
