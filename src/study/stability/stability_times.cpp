// hard cases of time and input: millions of steps at rest and under cycling activation; values that are not finite

#include "frontalis/error.hpp"
#include "frontalis/runner/runner.hpp"
#include "study/stability/stability_cases.hpp"
#include "study/stability/stability_models.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace frontalis
{
namespace
{

// a small bar of voxels under gravity and a muscle
Model hanging_strand(const CaseFile& file)
{
  Model model = damped_block(file);
  model.gravity = { { 9.81, 0, -3 } };
  hold_face(model, 0, false);
  add_muscle(model, Muscle{ "strand", 1e3 * file.number("stress", "kPa"), false, true }, along_x);
  return model;
}

void long_rest(const StabilitySettings& settings, const CaseFile& file, Trial& trial)
{
  GuardedTrial motion(settings, trial, hanging_strand(file), false);
  const Controls held = motion.controls(static_cast<float>(file.number("activation")));
  motion.advance(file.seconds("switch"), held);
  motion.advance(file.seconds("to_rest"), held);
  const Vectors at_rest = motion.displacements();
  const double few = file.number("steps"), many = file.number("steps_in_full"), steps = settings.long_runs ? many : few;
  double worst = 0;
  Plot plot{ "Drift at equilibrium", "steps [1]", "farthest from where it was at rest [um]" };
  plot.curves = { { "", {}, {}, Plot::Style::line } };
  constexpr int looks = 100;
  for (int i = 0; i < looks; ++i)
  {
    motion.advance(steps / looks * motion.solver().time_step(), held);
    const double drift = farthest(motion.displacements(), at_rest);
    worst = std::max(worst, drift);
    plot.curves[0].add((i + 1) * steps / looks, 1e6 * drift);
    settings.watch((i + 1.0) / looks);
  }
  trial.plots.emplace_back("long_rest", plot);
  trial.checks.absolute("drift", "um", 0, 1e6 * worst, file.bound("drift", "um"));
}

void long_cycling(const StabilitySettings& settings, const CaseFile& file, Trial& trial)
{
  GuardedTrial motion(settings, trial, hanging_strand(file));
  const double few = file.number("steps"), many = file.number("steps_in_full"), steps = settings.long_runs ? many : few;
  const double period = file.seconds("period");
  const int cycles = static_cast<int>(steps * motion.solver().time_step() / period);
  Vectors low, high;
  double worst = 0;
  for (int i = 0; i < cycles; ++i)
  {
    motion.advance(period / 2, motion.controls(1));
    const Vectors up = motion.displacements();
    motion.advance(period / 2, motion.controls(0));
    const Vectors down = motion.displacements();
    // the first swing has died away by the 20th cycle
    if (i == 20)
    {
      high = up;
      low = down;
    }
    if (i > 20)
      worst = std::max({ worst, farthest(up, high), farthest(down, low) });
    settings.watch((i + 1.0) / cycles);
  }
  motion.check_balance(file, "every cycle", "long_cycling", "Activation goes up and down 20 times a second");
  trial.checks.absolute("a cycle off the 20th", "um", 0, 1e6 * worst, file.bound("cycle", "um"));
}

// Gives values that are not finite to every function that takes numbers. Each must refuse them with an Error and leave
// the motion as it was.
void no_number(const StabilitySettings& settings, const CaseFile& file, Trial& trial)
{
  Model model = hanging_strand(file);
  model.rigid.clear();
  hold_face(model, 0, false, "bone");
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  double let_in = 0;
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
    let_in += 1;
    trial.failure += (trial.failure.empty() ? "let in: " : ", ") + what;
  };
  GuardedTrial motion(settings, trial, model);
  motion.advance(file.seconds("before"), motion.controls(0.5F), 10);
  const Vectors before = motion.displacements();
  Solver& solver = motion.solver();
  for (const double bad : { nan, infinite, -infinite })
  {
    const std::string value = readable(bad);
    refused("activation " + value, [&] { solver.advance(1e-3, motion.controls(static_cast<float>(bad))); });
    refused("settling at activation " + value,
            [&] { solver.settle(motion.controls(static_cast<float>(bad)), 1e-3, 1); });
    RigidTransform pose;
    pose.translation[1] = bad;
    refused("bone's place " + value, [&] { solver.advance(1e-3, motion.controls(0.5F, pose)); });
    pose = {};
    pose.rotation[4] = bad;
    refused("bone's rotation " + value, [&] { solver.advance(1e-3, motion.controls(0.5F, pose)); });
    refused("duration " + value, [&] { solver.advance(bad, motion.controls(0.5F)); });
    Runner runner(std::make_shared<const Model>(model), { { settings.backend, 1, 0 }, Pace::lock_step, 0 },
                  [](const Frame&) {});
    refused("runner's activation " + value, [&] { runner.set_activation({ { "strand", bad } }); });
    refused("runner's bone " + value, [&] { runner.set_bone("bone", pose); });
    refused("runner's step " + value, [&] { runner.step(bad); });
    Model broken = model;
    broken.materials[0].parameters[0] = bad;
    refused("modulus " + value, [&] { check_model(broken); });
    broken = model;
    broken.gravity[2] = bad;
    refused("gravity " + value, [&] { check_model(broken); });
    broken = model;
    broken.fill[3] = static_cast<float>(bad);
    refused("fill " + value, [&] { check_model(broken); });
    broken = model;
    broken.fibre_direction[2][1] = static_cast<float>(bad);
    refused("fibre " + value, [&] { check_model(broken); });
    broken = model;
    broken.muscles[0].stress_reference = bad;
    refused("muscle's stress " + value, [&] { check_model(broken); });
  }
  trial.checks.absolute("let in", "", 0, let_in, 0);
  trial.checks.absolute("motion changed meanwhile", "um", 0, 1e6 * farthest(motion.displacements(), before), 0);
  // velocities are set unchecked, so that only the guard can find them
  motion.advance(file.seconds("between"), motion.controls(0.5F));
  solver.set_velocities(Vectors(model.nodes.size(), { { nan, infinite, nan } }));
  motion.advance(file.seconds("after"), motion.controls(0.5F), 10);
  motion.check_balance(file, "before and after");
}

}  // namespace

CaseFunctions hard_times()
{
  return { { "long_rest", long_rest }, { "long_cycling", long_cycling }, { "no_number", no_number } };
}

}  // namespace frontalis
