// what muscles make hard: held neighbours, opposed pull, strength beside softness, faces that are switched

#include "stability_cases.hpp"
#include "stability_models.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace frontalis
{
namespace
{

const std::array<float, 3> along_x{ { 1, 0, 0 } };

// half of a bar that is held at both ends contracts and draws the other half: by as much as fat bears it comes back, by
// more it crushes itself
void held_neighbours(const StabilitySettings& settings, Trial& trial)
{
  for (const double stress : { 0.3e6, 5e6 })
  {
    Model model = soft_block({ { 12, 4, 4 } });
    model.damping = 50;
    add_muscles(model, { Muscle{ "half", stress, false, true } },
                [&](std::size_t e) -> std::vector<Fibre>
                {
                  if (model.voxels[e][0] < 6)
                    return { { 0, along_x } };
                  return {};
                });
    hold_face(model, 0, false);
    hold_face(model, 0, true);
    WatchedMotion motion(settings, trial, model);
    const std::string name = readable(stress / 1e6) + " MPa";
    const auto play = [&]
    {
      motion.advance(1e-3, motion.controls(0.75F), 10);
      motion.advance(50e-3, motion.controls(0.75F), 50);
      motion.advance(1e-3, motion.controls(0), 10);
      motion.advance(0.2, motion.controls(0), 20);
      motion.expect_balance(name, 0.02);
      trial.checks.push_back(
          absolute_check("left in the end, " + name, "mm", 0, 1e3 * farthest(motion.displacements()), 0.05));
    };
    if (stress < 1e6)
      play();
    else
      motion.hold_or_stop(play);
    motion.plot("held_neighbours_" + std::to_string(std::lround(stress / 1e3)),
                "Half of a held bar contracts by " + name + " at activation 0.75");
  }
}

void opposed_muscles(const StabilitySettings& settings, Trial& trial)
{
  Model model = soft_block({ { 9, 9, 3 } });
  model.materials.push_back(neo_hookean(0.5e6, 0.49));
  model.damping = 50;
  const float s = std::sqrt(0.5F);
  // three muscles over each other in the middle, one of them across the two others
  add_muscles(
      model,
      { Muscle{ "left", 5e6, true, true }, Muscle{ "right", 5e6, true, true }, Muscle{ "across", 5e6, true, true } },
      [&](std::size_t e) -> std::vector<Fibre>
      {
        const auto& v = model.voxels[e];
        std::vector<Fibre> fibres;
        if (v[0] < 6)
          fibres.push_back({ 0, { { s, s, 0 } }, 0.4F });
        if (v[0] > 2)
          fibres.push_back({ 1, { { -s, s, 0 } }, 0.4F });
        if (v[1] > 2 && v[1] < 6)
          fibres.push_back({ 2, { { 0, 0, 1 } }, 0.2F });
        return fibres;
      });
  mix(model,
      [&](std::size_t) -> std::vector<std::pair<int, float>> {
        return { { 0, 0.5F }, { 1, 0.5F } };
      });
  hold_face(model, 0, false);
  hold_face(model, 0, true);
  WatchedMotion motion(settings, trial, model);
  motion.come_and_go(
      { { 1e-3, motion.controls(1), 10 }, { 50e-3, motion.controls(1), 50 }, { 1e-3, motion.controls(0), 10 } },
      "full activation and back", 0.02, 0.05e-3, "opposed_muscles",
      "Three muscles of 5 MPa pull the same voxels three ways, and let go");
}

void strong_muscle(const StabilitySettings& settings, Trial& trial)
{
  Model model = soft_block({ { 16, 6, 6 } });
  model.materials.push_back(neo_hookean(0.5e6, 0.49));
  model.damping = 50;
  const auto in_muscle = [&](std::size_t e)
  {
    const auto& v = model.voxels[e];
    return v[0] >= 3 && v[0] < 13 && v[1] >= 2 && v[1] < 4 && v[2] >= 2 && v[2] < 4;
  };
  mix(model,
      [&](std::size_t e) -> std::vector<std::pair<int, float>> {
        return { { in_muscle(e) ? 1 : 0, 1.0F } };
      });
  add_muscles(model, { Muscle{ "strand", 5e6, true, true } },
              [&](std::size_t e) -> std::vector<Fibre>
              {
                if (in_muscle(e))
                  return { { 0, along_x } };
                return {};
              });
  hold_face(model, 2, false);
  WatchedMotion motion(settings, trial, model);
  motion.come_and_go({ { 10e-3, motion.controls(1), 20 },
                       { 50e-3, motion.controls(1), 30 },
                       { 1e-4, motion.controls(0), 1 },
                       { 10e-3, motion.controls(0), 40 },
                       { 0.1, motion.controls(0), 10 } },
                     "contracted and released", 0.02, 0.05e-3, "strong_muscle",
                     "A muscle of 5 MPa in fat of 34 kPa, released at full contraction");
}

// every muscle of a face from rest to full activation at once
void switch_on(const StabilitySettings& settings, Trial& trial, const std::string& scene, double seconds)
{
  // checked often: a switch is a matter of some hundred steps
  WatchedMotion motion(settings, trial, settings.scene(scene), true, { 128 });
  motion.advance(motion.solver().time_step(), motion.controls(1), 1);
  motion.advance(seconds, motion.controls(1), 40);
  motion.advance(motion.solver().time_step(), motion.controls(0), 1);
  motion.advance(seconds, motion.controls(0), 40);
  motion.expect_balance("every muscle on and off at once", 0.05);
  // whose head it was is nobody's business
  if (scene == "forehead")
    motion.plot(scene + "_switched", "Every muscle switched on in one step, and off");
}

void forehead_switched(const StabilitySettings& settings, Trial& trial) { switch_on(settings, trial, "forehead", 0.3); }
void real_head(const StabilitySettings& settings, Trial& trial) { switch_on(settings, trial, "real_head", 0.3); }

void forehead_at_random(const StabilitySettings& settings, Trial& trial)
{
  WatchedMotion motion(settings, trial, settings.scene("forehead"), true, { 128 });
  std::mt19937 random(11);
  const int changes = settings.long_runs ? 500 : 50;
  for (int i = 0; i < changes; ++i)
  {
    Controls target = motion.controls();
    for (float& a : target.activation)
      a = static_cast<float>(static_cast<double>(random()) / 4294967295.0);
    motion.advance(motion.solver().time_step(), target);
    motion.advance(0.02 - motion.solver().time_step(), target);
    settings.watch((i + 1.0) / changes);
  }
  motion.expect_balance("activations at random, 50 times a second", 0.05);
  motion.plot("forehead_at_random", "Every muscle of the forehead at random, 50 times a second");
}

}  // namespace

std::vector<StabilityCase> hard_muscles()
{
  return {
    { "held_neighbours", true, "contraction that only soft, held neighbours resist",
      "Half of a bar that is held at both ends contracts at activation 0.75 and draws the other half. At 0.3 MPa it "
      "must hold and come back to rest; at 5 MPa, 150 times Young's modulus, it may do so or be stopped in a finite "
      "state with a report that names voxel, muscle and cure. Without the guard the fibres crush their voxels, the "
      "time step goes to nothing, and the run does not end.",
      held_neighbours },
    { "opposed_muscles", true, "overlapping muscles that pull three ways",
      "Three muscles of 5 MPa lie in the same voxels, two across each other and one through both, and are switched on "
      "and off within a millisecond. Energy explained to 2 %, at rest in the end.",
      opposed_muscles },
    { "strong_muscle", true, "5 MPa of muscle in fat, let go when fully contracted",
      "A muscle of 5 MPa in fat of 34 kPa contracts fully and is released at once. Energy explained to 2 %, at rest in "
      "the end.",
      strong_muscle },
    { "forehead_switched", true, "every muscle of a forehead switched in one step",
      "The generated forehead, in the setting of the demo (assembled time step, selective mass scaling), every muscle "
      "from 0 to 1 within one step, and off again. Energy explained to 5 %. Where the assembled bound is not renewed "
      "when activations change, twice the ledger's largest term comes from nowhere and the worst J is 0.29.",
      forehead_switched },
    { "forehead_at_random", true, "every muscle at random, 50 times a second",
      "The same forehead, every muscle at random 50 times a second, for 1 s (10 s with `--all`). Energy explained to "
      "5 %.",
      forehead_at_random },
    { "real_head", true, "a real head, every muscle switched in one step",
      "A real head's forehead, every muscle from 0 to 1 within one step, and off again. Needs its meshes "
      "(`--mesh-dir`).",
      real_head }
  };
}

}  // namespace frontalis
