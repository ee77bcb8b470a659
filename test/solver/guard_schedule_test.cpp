// When the guard checks a motion whose time step changes.

#include "backends.hpp"
#include "effect_scene.hpp"
#include "wrapped_solver.hpp"

#include "frontalis/solver/guard.hpp"

namespace frontalis
{
namespace
{

class GuardSchedule : public test::EveryBackend
{
};

/// A solver that announces steps `share` times as long as those that it makes.
struct Announcing : test::WrappedSolver
{
  using WrappedSolver::WrappedSolver;
  double share = 1;
  double time_step() const override { return share * WrappedSolver::time_step(); }
};

// A frame may end long before the next regular check.
TEST_P(GuardSchedule, checks_at_once_when_the_time_step_falls)
{
  const auto model = std::make_shared<const Model>(test::scene_of(test::contraction));
  Announcing solver(make_solver(model, { GetParam(), 2 }));
  Guard guard(solver, model, { 100000 });
  const double part = 10 * solver.time_step();
  for (const auto& [share, checks] : { std::pair<double, int>{ 1, 0 }, { 0.6, 0 }, { 0.4, 1 }, { 0.4, 1 } })
  {
    solver.share = share;
    guard.advance(part, solver.controls());
    EXPECT_EQ(guard.counts().checks, checks) << share;
  }
}

TEST_P(GuardSchedule, checks_before_the_end_of_a_part_whose_steps_become_short)
{
  const auto model = std::make_shared<const Model>(test::scene_of(test::contraction));
  Announcing solver(make_solver(model, { GetParam(), 2 }));
  solver.share = 100;
  Guard guard(solver, model, { 64 });
  guard.advance(64 * solver.time_step(), solver.controls());
  EXPECT_GE(solver.profile().steps, 6000);
  EXPECT_GE(guard.counts().checks, 10);
}

FRONTALIS_EVERY_BACKEND(GuardSchedule);

}  // namespace
}  // namespace frontalis
