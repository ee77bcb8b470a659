// hard cases of muscles: held neighbours, opposed muscles, strong muscles in soft tissue, faces that are switched

#include "study/stability/stability_cases.hpp"
#include "study/stability/stability_models.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace frontalis
{
namespace
{

// Half of a bar that is held at both ends contracts and stretches the other half. Under a moderate stress it comes back
// to rest; under a high one it crushes itself.
void held_neighbours(const StabilitySettings& settings, const CaseFile& file, Trial& trial)
{
  const auto activation = static_cast<float>(file.number("activation"));
  const double held = 1e6 * file.number("stress_held", "MPa");
  for (const double stress : { held, 1e6 * file.number("stress_held_or_stopped", "MPa") })
  {
    Model model = damped_block(file);
    add_muscles(model, { Muscle{ "half", stress, false, true } },
                [&](std::size_t e) -> std::vector<Fibre>
                {
                  if (2 * model.voxels[e][0] < model.size[0])
                    return { { 0, along_x(e) } };
                  return {};
                });
    hold_face(model, 0, false);
    hold_face(model, 0, true);
    GuardedTrial motion(settings, trial, model);
    const std::string name = readable(stress / 1e6) + " MPa";
    const auto play = [&]
    {
      const double switched = file.seconds("switch");
      motion.advance(switched, motion.controls(activation), 10);
      motion.advance(file.seconds("pull"), motion.controls(activation), 50);
      motion.advance(switched, motion.controls(0), 10);
      motion.advance(file.seconds("rest"), motion.controls(0), 20);
      motion.check_balance(file, name);
      trial.checks.absolute("left in the end, " + name, "mm", 0, 1e3 * farthest(motion.displacements()),
                            file.bound("left", "mm"));
    };
    if (stress == held)
      play();
    else
      motion.hold_or_stop(play);
    motion.plot(fmt::format("held_neighbours_{}", std::lround(stress / 1e3)),
                fmt::format("Half of a held bar contracts by {} at activation {:g}", name, activation));
  }
}

void opposed_muscles(const StabilitySettings& settings, const CaseFile& file, Trial& trial)
{
  Model model = damped_block(file);
  model.materials.push_back(neo_hookean(0.5e6, 0.49));
  const float s = std::sqrt(0.5F);
  const double stress = 1e6 * file.number("stress", "MPa");
  // three muscles overlap in the middle, one of them across the two others
  add_muscles(model,
              { Muscle{ "left", stress, true, true }, Muscle{ "right", stress, true, true },
                Muscle{ "across", stress, true, true } },
              [&](std::size_t e) -> std::vector<Fibre>
              {
                const auto& v = model.voxels[e];
                std::vector<Fibre> fibres;
                const auto& n = model.size;
                if (3 * v[0] < 2 * n[0])
                  fibres.push_back({ 0, { { s, s, 0 } }, 0.4F });
                if (3 * v[0] >= n[0])
                  fibres.push_back({ 1, { { -s, s, 0 } }, 0.4F });
                if (3 * v[1] >= n[1] && 3 * v[1] < 2 * n[1])
                  fibres.push_back({ 2, { { 0, 0, 1 } }, 0.2F });
                return fibres;
              });
  mix(model,
      [&](std::size_t) -> std::vector<std::pair<int, float>> {
        return { { 0, 0.5F }, { 1, 0.5F } };
      });
  hold_face(model, 0, false);
  hold_face(model, 0, true);
  GuardedTrial motion(settings, trial, model);
  const double switched = file.seconds("switch");
  motion.play_and_release({ { switched, motion.controls(1), 10 },
                            { file.seconds("pull"), motion.controls(1), 50 },
                            { switched, motion.controls(0), 10 } },
                          "full activation and back", file, "opposed_muscles",
                          "Three muscles of 5 MPa pull the same voxels three ways, and let go");
}

void strong_muscle(const StabilitySettings& settings, const CaseFile& file, Trial& trial)
{
  Model model = damped_block(file);
  model.materials.push_back(neo_hookean(0.5e6, 0.49));
  const auto in_muscle = [&](std::size_t e)
  {
    const auto& v = model.voxels[e];
    const auto& n = model.size;
    return v[0] >= 3 && v[0] < n[0] - 3 && v[1] >= 2 && v[1] < n[1] - 2 && v[2] >= 2 && v[2] < n[2] - 2;
  };
  mix(model,
      [&](std::size_t e) -> std::vector<std::pair<int, float>> {
        return { { in_muscle(e) ? 1 : 0, 1.0F } };
      });
  add_muscles(model, { Muscle{ "strand", 1e6 * file.number("stress", "MPa"), true, true } },
              [&](std::size_t e) -> std::vector<Fibre>
              {
                if (in_muscle(e))
                  return { { 0, along_x(e) } };
                return {};
              });
  hold_face(model, 2, false);
  GuardedTrial motion(settings, trial, model);
  motion.play_and_release({ { file.seconds("contract"), motion.controls(1), 20 },
                            { file.seconds("hold"), motion.controls(1), 30 },
                            { file.seconds("release"), motion.controls(0), 1 },
                            { file.seconds("watched"), motion.controls(0), 40 },
                            { file.seconds("rest"), motion.controls(0), 10 } },
                          "contracted and released", file, "strong_muscle",
                          "A muscle of 5 MPa in fat of 34 kPa, released at full contraction");
}

// every muscle of a face from rest to full activation at once
void switch_on(const StabilitySettings& settings, const CaseFile& file, Trial& trial, const std::string& scene)
{
  // checked often, since the motion after a switch takes some hundred steps
  GuardedTrial motion(settings, trial, settings.scene(scene), true, { 128 });
  motion.advance(motion.solver().time_step(), motion.controls(1), 1);
  motion.advance(file.seconds("on"), motion.controls(1), 40);
  motion.advance(motion.solver().time_step(), motion.controls(0), 1);
  motion.advance(file.seconds("off"), motion.controls(0), 40);
  motion.check_balance(file, "every muscle on and off at once");
  // a picture of the real head's motion would tell whose head it is
  if (scene == "forehead")
    motion.plot(scene + "_switched", "Every muscle switched on in one step, and off");
}

void forehead_switched(const StabilitySettings& settings, const CaseFile& file, Trial& trial)
{
  switch_on(settings, file, trial, "forehead");
}
void real_head(const StabilitySettings& settings, const CaseFile& file, Trial& trial)
{
  switch_on(settings, file, trial, "real_head");
}

void forehead_at_random(const StabilitySettings& settings, const CaseFile& file, Trial& trial)
{
  GuardedTrial motion(settings, trial, settings.scene("forehead"), true, { 128 });
  std::mt19937 random(11);
  const double changed = file.seconds("change"), few = file.number("changes"), many = file.number("changes_in_full");
  const int changes = static_cast<int>(settings.long_runs ? many : few);
  for (int i = 0; i < changes; ++i)
  {
    Controls target = motion.controls();
    for (float& a : target.activation)
      a = static_cast<float>(static_cast<double>(random()) / 4294967295.0);
    motion.advance(motion.solver().time_step(), target);
    motion.advance(changed - motion.solver().time_step(), target);
    settings.watch((i + 1.0) / changes);
  }
  motion.check_balance(file, "activations at random, 50 times a second", "forehead_at_random",
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
