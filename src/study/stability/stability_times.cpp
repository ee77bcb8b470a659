// Hard cases of time and input: millions of steps at rest and under cycling activation; values that are not finite.

#include "frontalis/error.hpp"
#include "frontalis/runner/runner.hpp"
#include "study/stability/stability_cases.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace frontalis
{
namespace
{

// A small bar with a muscle along it, under gravity.
Model hanging_strand(const CaseRun& run)
{
  Model model = damped_block(run);
  model.gravity = { { 9.81, 0, -3 } };
  hold_face(model, 0, false);
  add_muscle(model, Muscle{ "strand", 1e3 * run.number("stress", "kPa"), false, true }, along_x);
  return model;
}

void long_rest(CaseRun& run)
{
  GuardedTrial motion(run, hanging_strand(run), false);
  const Controls held = motion.controls(static_cast<float>(run.number("activation")));
  motion.advance({ run.seconds("switch"), held });
  motion.advance({ run.seconds("to_rest"), held });
  const Vectors at_rest = motion.displacements();
  const double steps = run.count("steps");
  double worst = 0;
  Plot plot{ "Drift at equilibrium", "steps [1]", "farthest from where it was at rest [um]" };
  plot.curves = { { "", {}, {}, Plot::Style::line } };
  constexpr int parts = 100;
  for (int i = 0; i < parts; ++i)
  {
    motion.advance({ steps / parts * motion.solver().time_step(), held });
    const double drift = farthest(motion.displacements(), at_rest);
    worst = std::max(worst, drift);
    plot.curves[0].add((i + 1) * steps / parts, 1e6 * drift);
    run.settings.watch((i + 1.0) / parts);
  }
  run.trial.plots.emplace_back("long_rest", plot);
  run.check("drift", "um", 0, 1e6 * worst, "drift");
}

void long_cycling(CaseRun& run)
{
  GuardedTrial motion(run, hanging_strand(run));
  const double steps = run.count("steps");
  const double period = run.seconds("period");
  const int cycles = static_cast<int>(steps * motion.solver().time_step() / period);
  Vectors low, high;
  double worst = 0;
  for (int i = 0; i < cycles; ++i)
  {
    motion.advance({ period / 2, motion.controls(1) });
    const Vectors up = motion.displacements();
    motion.advance({ period / 2, motion.controls(0) });
    const Vectors down = motion.displacements();
    // The initial vibration has died away by the 20th cycle.
    if (i == 20)
    {
      high = up;
      low = down;
    }
    if (i > 20)
      worst = std::max({ worst, farthest(up, high), farthest(down, low) });
    run.settings.watch((i + 1.0) / cycles);
  }
  motion.check_balance("every cycle", "long_cycling", "Activation goes up and down 20 times a second");
  run.check("deviation from the 20th cycle", "um", 0, 1e6 * worst, "cycle");
}

// Passes non-finite values to every function that takes numbers. Each must throw an Error and leave the motion
// unchanged.
void no_number(CaseRun& run)
{
  Model model = hanging_strand(run);
  model.rigid.clear();
  hold_face(model, 0, false, "bone");
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  double accepted = 0;
  const auto refused = [&](const std::string& what, const std::function<void()>& go)
  {
    try
    {
      go();
    }
    catch (const Error&)
    {
      return;
    }
    accepted += 1;
    run.trial.failure += (run.trial.failure.empty() ? "accepted: " : ", ") + what;
  };
  const auto refused_in_a_model = [&](const std::string& what, const std::function<void(Model&)>& spoil)
  {
    Model broken = model;
    spoil(broken);
    refused(what, [&] { check_model(broken); });
  };
  GuardedTrial motion(run, model);
  motion.advance({ run.seconds("before"), motion.controls(0.5F), 10 });
  const Vectors before = motion.displacements();
  Solver& solver = motion.solver();
  for (const double bad : { nan, infinite, -infinite })
  {
    const std::string value = readable(bad);
    const auto single = static_cast<float>(bad);
    refused("activation " + value, [&] { solver.advance(1e-3, motion.controls(single)); });
    refused("settling at activation " + value, [&] { solver.settle(motion.controls(single), 1e-3, 1); });
    RigidTransform pose = shifted({ { 0, bad, 0 } });
    refused("bone's place " + value, [&] { solver.advance(1e-3, motion.controls(0.5F, pose)); });
    pose = {};
    pose.rotation[4] = bad;
    refused("bone's rotation " + value, [&] { solver.advance(1e-3, motion.controls(0.5F, pose)); });
    refused("duration " + value, [&] { solver.advance(bad, motion.controls(0.5F)); });
    Runner runner(std::make_shared<const Model>(model), { { run.settings.backend, 1, 0 }, Pace::lock_step, 0 },
                  [](const Frame&) {});
    refused("runner's activation " + value, [&] { runner.set_activation({ { "strand", bad } }); });
    refused("runner's bone " + value, [&] { runner.set_bone("bone", pose); });
    refused("runner's step " + value, [&] { runner.step(bad); });
    refused_in_a_model("modulus " + value, [&](Model& broken) { broken.materials[0].parameters[0] = bad; });
    refused_in_a_model("gravity " + value, [&](Model& broken) { broken.gravity[2] = bad; });
    refused_in_a_model("fill " + value, [&](Model& broken) { broken.fill[3] = single; });
    refused_in_a_model("fibre " + value, [&](Model& broken) { broken.fibre_direction[2][1] = single; });
    refused_in_a_model("muscle's stress " + value, [&](Model& broken) { broken.muscles[0].stress_reference = bad; });
  }
  run.trial.checks.absolute("values accepted", "", 0, accepted, 0);
  run.trial.checks.absolute("motion changed meanwhile", "um", 0, 1e6 * farthest(motion.displacements(), before), 0);
  // set_velocities() does not check its values, so that the guard must find them.
  motion.advance({ run.seconds("between"), motion.controls(0.5F) });
  solver.set_velocities(Vectors(model.nodes.size(), { { nan, infinite, nan } }));
  motion.advance({ run.seconds("after"), motion.controls(0.5F), 10 });
  motion.check_balance("before and after");
}

}  // namespace

CaseFunctions hard_times()
{
  return { { "long_rest", long_rest }, { "long_cycling", long_cycling }, { "no_number", no_number } };
}

}  // namespace frontalis
