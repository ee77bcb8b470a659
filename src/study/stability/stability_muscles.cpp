// Hard cases of muscles: neighbours of passive tissue, opposed and strong muscles, faces activated at once.

#include "study/stability/stability_cases.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace frontalis
{
namespace
{

using Fibres = std::vector<Fibre>;

// Half of a bar contracts and stretches the other half, with both ends fixed. With a moderate active stress the bar
// must return to rest; with a high one it crushes itself, and the guard may stop it.
void held_neighbours(CaseRun& run)
{
  const auto activation = static_cast<float>(run.number("activation"));
  const double held = 1e6 * run.number("stress_held", "MPa");
  for (const double stress : { held, 1e6 * run.number("stress_held_or_stopped", "MPa") })
  {
    Model model = damped_block(run);
    add_muscles(model, { Muscle{ "half", stress, false, true } },
                [&](std::size_t e) {
                  return 2 * model.voxels[e][0] < model.size[0] ? Fibres{ { 0, along_x(e) } } : Fibres();
                });
    hold_ends(model, 0);
    GuardedTrial motion(run, model);
    const std::string name = readable(stress / 1e6) + " MPa";
    const auto play = [&]
    {
      const double switched = run.seconds("switch");
      motion.advance({ switched, motion.controls(activation), 10 });
      motion.advance({ run.seconds("pull"), motion.controls(activation), 50 });
      motion.advance({ switched, motion.controls(0), 10 });
      motion.advance({ run.seconds("rest"), motion.controls(0), 20 });
      motion.check_balance(name);
      run.check("remaining displacement, " + name, "mm", 0, 1e3 * farthest(motion.displacements()), "left");
    };
    if (stress == held)
      play();
    else
      motion.hold_or_stop(play);
    motion.plot(fmt::format("held_neighbours_{}", std::lround(stress / 1e3)),
                fmt::format("Half of a held bar contracts by {} at activation {:g}", name, activation));
  }
}

void opposed_muscles(CaseRun& run)
{
  Model model = damped_block(run);
  model.materials.push_back(neo_hookean(0.5e6, 0.49));
  const float s = std::sqrt(0.5F);
  const double stress = 1e6 * run.number("stress", "MPa");
  // Three muscles overlap in the middle; the third is perpendicular to the others.
  add_muscles(model,
              { Muscle{ "left", stress, true, true }, Muscle{ "right", stress, true, true },
                Muscle{ "across", stress, true, true } },
              [&](std::size_t e)
              {
                const auto &v = model.voxels[e], &n = model.size;
                Fibres fibres;
                if (3 * v[0] < 2 * n[0])
                  fibres.push_back({ 0, { { s, s, 0 } }, 0.4F });
                if (3 * v[0] >= n[0])
                  fibres.push_back({ 1, { { -s, s, 0 } }, 0.4F });
                if (3 * v[1] >= n[1] && 3 * v[1] < 2 * n[1])
                  fibres.push_back({ 2, { { 0, 0, 1 } }, 0.2F });
                return fibres;
              });
  mix(model, [](std::size_t) { return Mixture{ { 0, 0.5F }, { 1, 0.5F } }; });
  hold_ends(model, 0);
  GuardedTrial motion(run, model);
  const double switched = run.seconds("switch");
  motion.play_and_release({ { switched, motion.controls(1), 10 },
                            { run.seconds("pull"), motion.controls(1), 50 },
                            { switched, motion.controls(0), 10 } },
                          "full activation and back", "opposed_muscles",
                          "Three muscles of 5 MPa pull the same voxels three ways, and let go");
}

void strong_muscle(CaseRun& run)
{
  Model model = damped_block(run);
  model.materials.push_back(neo_hookean(0.5e6, 0.49));
  const auto in_muscle = [&](std::size_t e)
  {
    const auto &v = model.voxels[e], &n = model.size;
    return v[0] >= 3 && v[0] < n[0] - 3 && v[1] >= 2 && v[1] < n[1] - 2 && v[2] >= 2 && v[2] < n[2] - 2;
  };
  mix(model, [&](std::size_t e) { return Mixture{ { in_muscle(e) ? 1 : 0, 1.0F } }; });
  add_muscles(model, { Muscle{ "strand", 1e6 * run.number("stress", "MPa"), true, true } },
              [&](std::size_t e) {
                return in_muscle(e) ? Fibres{ { 0, along_x(e) } } : Fibres();
              });
  hold_face(model, 2, false);
  GuardedTrial motion(run, model);
  motion.play_and_release({ { run.seconds("contract"), motion.controls(1), 20 },
                            { run.seconds("hold"), motion.controls(1), 30 },
                            { run.seconds("release"), motion.controls(0), 1 },
                            { run.seconds("watched"), motion.controls(0), 40 },
                            { run.seconds("rest"), motion.controls(0), 10 } },
                          "contracted and released", "strong_muscle",
                          "A muscle of 5 MPa in fat of 34 kPa, released at full contraction");
}

// Activates every muscle of a face fully within one time step, and deactivates all of them within another.
void switch_on(CaseRun& run, const std::string& scene)
{
  // The guard checks every 128 steps, because the motion after a switch lasts only a few hundred steps.
  GuardedTrial motion(run, run.settings.scene(scene), true, { 128 });
  motion.advance({ motion.solver().time_step(), motion.controls(1), 1 });
  motion.advance({ run.seconds("on"), motion.controls(1), 40 });
  motion.advance({ motion.solver().time_step(), motion.controls(0), 1 });
  motion.advance({ run.seconds("off"), motion.controls(0), 40 });
  motion.check_balance("every muscle on and off at once");
  // The real head gets no plot, because its data are private.
  if (scene == "forehead")
    motion.plot(scene + "_switched", "Every muscle switched on in one step, and off");
}

void forehead_switched(CaseRun& run) { switch_on(run, "forehead"); }
void real_head(CaseRun& run) { switch_on(run, "real_head"); }

void forehead_at_random(CaseRun& run)
{
  GuardedTrial motion(run, run.settings.scene("forehead"), true, { 128 });
  std::mt19937 random(11);
  const double changed = run.seconds("change");
  const int changes = static_cast<int>(run.count("changes"));
  for (int i = 0; i < changes; ++i)
  {
    Controls target = motion.controls();
    for (float& a : target.activation)
      a = static_cast<float>(static_cast<double>(random()) / 4294967295.0);
    motion.advance({ motion.solver().time_step(), target });
    motion.advance({ changed - motion.solver().time_step(), target });
    run.settings.watch((i + 1.0) / changes);
  }
  motion.check_balance("activations at random, 50 times a second", "forehead_at_random",
                       "Every muscle of the forehead at random, 50 times a second");
}

}  // namespace

CaseFunctions hard_muscles()
{
  return { { "held_neighbours", held_neighbours },       { "opposed_muscles", opposed_muscles },
           { "strong_muscle", strong_muscle },           { "forehead_switched", forehead_switched },
           { "forehead_at_random", forehead_at_random }, { "real_head", real_head } };
}

}  // namespace frontalis
