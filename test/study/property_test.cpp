// random small scenes must stay finite, explain their energy or be stopped with a report, and repeat bit by bit

#include "frontalis/error.hpp"
#include "frontalis/solver/guard.hpp"
#include "frontalis/solver/rigid_motion.hpp"
#include "frontalis/solver/solver.hpp"
#include "frontalis/study/voxel_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#if __has_include(<rapidcheck.h>)
#include <rapidcheck.h>

using namespace frontalis;

namespace
{

// whole numbers shrink well: x / scale of one from low to high
double real(int low, int high, double scale) { return *rc::gen::inRange(low, high + 1) / scale; }

Material material()
{
  const double young = 10e3 * std::pow(10.0, real(0, 30, 10));
  Material result = neo_hookean(young, real(30, 49, 100));
  auto& p = result.parameters;
  const double mu = p[0];
  result.law = static_cast<Law>(*rc::gen::inRange(0, 6));
  if (result.law == Law::mooney_rivlin)
    p = { { 0.3 * mu, p[1], 0.2 * mu } };
  if (result.law == Law::ogden)
    p = { { 0.5 * mu, p[1], 2, -0.25 * mu, -4 } };
  if (result.law == Law::fung)
    p[2] = 1;
  if (result.law == Law::holzapfel)
    p = { { mu, p[1], mu, 1, real(0, 3, 10), 1, 0, 0, 0, 1, 0 } };
  if (result.law == Law::guccione)
    p = { { 0.25 * mu, p[1], 4, 2, 3, 0, 1, 0 } };
  if (*rc::gen::inRange(0, 4) == 0)
  {
    result.viscous_share[0] = real(1, 5, 10);
    result.viscous_time[0] = real(1, 50, 1000);
  }
  return result;
}

Model scene()
{
  VoxelBox box;
  for (auto& n : box.size)
    n = *rc::gen::inRange(1, 7);
  box.spacing = { { real(5, 20, 1e4), real(5, 20, 1e4), real(5, 20, 1e4) } };
  const int materials = *rc::gen::inRange(1, 4);
  for (int m = 0; m < materials; ++m)
    box.materials.push_back(material());
  const int holes = *rc::gen::inRange(0, 4), seed = *rc::gen::inRange(0, 1000);
  const auto drawn = [seed](const std::array<std::int32_t, 3>& v, int of)
  { return (v[0] * 73 + v[1] * 179 + v[2] * 283 + seed * (v[0] + 2 * v[1] + 5)) % of; };
  box.fill = [=](const std::array<std::int32_t, 3>& v) -> double
  {
    const bool first = v[0] == 0 && v[1] == 0 && v[2] == 0;
    return !first && drawn(v, 10) < holes ? 0.0 : drawn(v, 7) == 1 ? 0.4 : 1.0;
  };
  Model model = voxel_model(box);
  model.mixture_begin.assign(1, 0);
  model.mixture_material.clear();
  model.mixture_proportion.clear();
  for (const auto& v : model.voxels)
  {
    const int a = drawn(v, materials), b = drawn(v, 11) % materials;
    for (const auto& [m, share] : { std::pair(a, 0.7F), std::pair(b, 0.3F) })
    {
      model.mixture_material.push_back(static_cast<std::int16_t>(m));
      model.mixture_proportion.push_back(share);
    }
    model.mixture_begin.push_back(static_cast<std::int32_t>(model.mixture_material.size()));
  }
  model.damping = real(0, 5, 0.05);
  for (double& g : model.gravity)
    g = real(-20, 20, 1);
  model.hourglass = static_cast<HourglassControl>(*rc::gen::inRange(0, 2));
  model.integration = static_cast<Integration>(*rc::gen::inRange(0, 2));
  model.precision = static_cast<Precision>(*rc::gen::inRange(0, 3));
  model.time_step_estimate = static_cast<TimeStepEstimate>(*rc::gen::inRange(0, 2));
  if (*rc::gen::inRange(0, 3) > 0)
  {
    const float s = std::sqrt(0.5F);
    const Muscle muscle{ "muscle", 1e3 * real(1, 30, 1), *rc::gen::arbitrary<bool>(), *rc::gen::arbitrary<bool>() };
    add_muscle(model, muscle,
               [&](std::size_t e) -> std::array<float, 3>
               {
                 if (model.voxels[e][1] % 2 == 0)
                   return { { 1, 0, 0 } };
                 return { { 0, s, s } };
               });
  }
  if (*rc::gen::inRange(0, 3) > 0)
  {
    model.bones = { "bone" };
    for (const auto node : nodes_where(model, [](const auto& p) { return p[0] == 0; }))
      model.rigid.push_back({ node, 0 });
  }
  if (*rc::gen::inRange(0, 3) == 0)
  {
    const double wide = 1, low = -0.2e-3;
    model.constraint_surfaces.push_back(
        { "floor",
          { { { { -wide, -wide, low } }, { { wide, -wide, low } }, { { wide, wide, low } }, { { -wide, wide, low } } },
            { { { 0, 1, 2 } }, { { 0, 2, 3 } } } } });
    for (const auto node : nodes_where(model, [](const auto& p) { return p[0] > 0 && p[2] == 0; }))
      model.sliding.push_back({ node, 0, -low });
  }
  return model;
}

struct Outcome
{
  std::vector<std::array<double, 3>> displacements;
  EnergyLedger ledger;
  Monitor monitor;
  bool stopped = false;  ///< by the guard, with a report
};

// 500 steps: muscles are switched on, off and half on, a bone goes away and comes back
Outcome play(const std::shared_ptr<const Model>& model, const std::vector<float>& activation,
             const RigidTransform& away, int threads)
{
  SolverSettings settings{ Backend::cpu, threads, 0 };
  settings.ledger = true;
  const auto solver = make_solver(model, settings);
  Guard guard(*solver, model, { 100 });
  Outcome outcome;
  for (std::size_t part = 0; part < activation.size(); ++part)
  {
    Controls target = solver->controls();
    std::fill(target.activation.begin(), target.activation.end(), activation[part]);
    std::fill(target.bone.begin(), target.bone.end(), part % 2 == 0 ? away : RigidTransform());
    try
    {
      guard.advance(500.0 / static_cast<double>(activation.size()) * solver->time_step(), target);
    }
    catch (const Unstable&)
    {
      outcome.stopped = true;
      break;
    }
    outcome.ledger = solver->ledger();
  }
  solver->displacements(outcome.displacements);
  outcome.monitor = solver->monitor();
  return outcome;
}

}  // namespace

TEST(Property, RandomScenesStayFiniteExplainTheirEnergyAndRepeat)
{
  // a seed and a number that stand unless the environment says otherwise (RC_PARAMS="max_success=10000")
  ::setenv("RC_PARAMS", "seed=20261121 max_success=200", 0);
  int scenes = 0, stopped = 0;
  const bool held = rc::check(
      [&]()
      {
        const auto model = std::make_shared<const Model>(scene());
        std::vector<float> activation;
        for (int part = 0; part < 5; ++part)
          activation.push_back(static_cast<float>(real(0, 4, 4)));
        const double h = *std::min_element(model->spacing.begin(), model->spacing.end());
        const RigidTransform away =
            rigid_motion({ { 0, 0, real(-3, 3, 10) } }, { { h * real(-4, 4, 10), h * real(-4, 4, 10), 0 } });
        const Outcome first = play(model, activation, away, 1);
        RC_ASSERT(first.monitor.finite);
        RC_CLASSIFY(first.stopped);
        ++scenes;
        stopped += first.stopped ? 1 : 0;
        if (!first.stopped)
        {
          RC_ASSERT(std::isfinite(first.ledger.imbalance()));
          RC_ASSERT(std::abs(first.ledger.imbalance()) <= 0.1 * first.ledger.largest + 1e-12);
        }
        RC_ASSERT(play(model, activation, away, 1).displacements == first.displacements);
        RC_ASSERT(play(model, activation, away, 2).displacements == first.displacements);
      });
  EXPECT_TRUE(held);
  // a guard that stopped them all would hide what the others are to show
  EXPECT_LT(stopped, 0.2 * scenes);
  EXPECT_GT(scenes, 0);
}

#else

TEST(Property, RandomScenesStayFiniteExplainTheirEnergyAndRepeat) { GTEST_SKIP() << "built without RapidCheck"; }

#endif
