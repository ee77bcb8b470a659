// hard cases of materials: near-incompressibility, contrasts, thin layers, stiffening, scaled mass

#include "frontalis/physics/materials/all.hpp"
#include "frontalis/study/equilibrium.hpp"
#include "study/stability/stability_cases.hpp"
#include "study/stability/stability_models.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

RigidTransform shifted(double x, double y, double z) { return { RigidTransform().rotation, { { x, y, z } } }; }

RigidTransform shifted(const std::vector<double>& millimetres)
{
  return shifted(1e-3 * millimetres[0], 1e-3 * millimetres[1], 1e-3 * millimetres[2]);
}

Model cantilever(const CaseFile& file, double poisson)
{
  Model model = soft_block(file.size());
  model.materials = { soft_tissue(poisson) };
  hold_face(model, 0, false);
  model.gravity = { { 0, 0, -9.81 } };
  return model;
}

double settled_tip(const CaseFile& file, GuardedTrial& motion)
{
  motion.settle(motion.controls(), 1e-4, file.seconds("longest_settling"));
  const double last = 1e-3 * (motion.model().size[0] - 0.5);
  const auto end = nodes_where(motion.model(), [&](const auto& p) { return p[0] > last; });
  return 1e3 * mean_displacement(motion.displacements(), end)[2];
}

void near_incompressible(const StabilitySettings& settings, const CaseFile& file, Trial& trial)
{
  GuardedTrial plain(settings, trial, cantilever(file, file.number("poisson_ratio_of_the_expected")));
  const double expected = settled_tip(file, plain);
  for (const double poisson : file.numbers("poisson_ratios"))
  {
    const std::string name = "ν = " + readable(poisson);
    GuardedTrial motion(settings, trial, cantilever(file, poisson));
    motion.advance(file.seconds("swing"), motion.controls(), 30);
    motion.check_balance(file, name, fmt::format("near_incompressible_{}", std::lround(1e4 * poisson)),
                         "A beam falls and swings, " + name);
    trial.checks.relative("tip's equilibrium, " + name, "mm", expected, settled_tip(file, motion),
                          0.01 * file.bound("tip", "%"));
  }
}

void stiffness_contrast(const StabilitySettings& settings, const CaseFile& file, Trial& trial)
{
  Model model = damped_block(file);
  model.materials = { soft_tissue(), neo_hookean(1e6 * file.number("tendon", "MPa"), 0.49),
                      neo_hookean(1e6 * file.number("corneum", "MPa"), 0.49),
                      neo_hookean(1e3 * file.number("dermis", "kPa"), 0.49) };
  // a chequerboard of tendon and fat; every fourth plane of voxels is half corneum and half dermis
  mix(model,
      [&](std::size_t e) -> std::vector<std::pair<int, float>>
      {
        const auto& v = model.voxels[e];
        if (v[0] % 4 == 3)
          return { { 2, 0.5F }, { 3, 0.5F } };
        return { { (v[0] + v[1] + v[2]) % 2, 1.0F } };
      });
  hold_face(model, 0, false);
  hold_face(model, 0, true, "grip");
  GuardedTrial motion(settings, trial, model);
  motion.play_and_release(
      { { file.seconds("draw"), motion.controls(0, shifted(file.numbers("drawn_by", "mm", 3))), 10 },
        { file.seconds("back"), motion.controls(), 10 },
        { file.seconds("rest"), motion.controls(), 10 } },
      "drawn by a quarter and back", file, "stiffness_contrast",
      "Tendon, fat and mixed voxels drawn by a quarter and back");
}

void thin_layer(const StabilitySettings& settings, const CaseFile& file, Trial& trial)
{
  Model model = damped_block(file);
  model.materials = { soft_tissue(), neo_hookean(1e6 * file.number("corneum", "MPa"), 0.49),
                      neo_hookean(1e3 * file.number("dermis", "kPa"), 0.49) };
  const auto corneum = static_cast<float>(file.number("corneum_of_a_voxel"));
  mix(model,
      [&](std::size_t e) -> std::vector<std::pair<int, float>>
      {
        const auto depth = model.size[2] - 1 - model.voxels[e][2];
        if (depth == 0)
          return { { 1, corneum }, { 2, 1 - corneum } };
        return depth == 1 ? std::vector<std::pair<int, float>>{ { 2, 0.8F }, { 0, 0.2F } }
                          : std::vector<std::pair<int, float>>{ { 0, 1.0F } };
      });
  hold_face(model, 0, false);
  hold_face(model, 0, true, "grip");
  GuardedTrial motion(settings, trial, model);
  const Controls drawn = motion.controls(0, shifted(file.numbers("drawn_by", "mm", 3))), back = motion.controls();
  const double phase = file.seconds("draw");
  motion.play_and_release({ { phase, drawn, 10 }, { phase, drawn, 10 }, { phase, back, 10 }, { phase, back, 10 } },
                          "shortened by a fifth and back", file, "thin_layer",
                          "Skin with 0.02 mm of stratum corneum, shortened by a fifth and back");
}

void stiffening(const StabilitySettings& settings, const CaseFile& file, Trial& trial)
{
  Model model = damped_block(file);
  Material& tissue = model.materials[0];
  tissue.law = law_of<physics::FungExponential>;
  tissue.parameters[2] = file.number("exponent");
  model.time_step_share = file.number("time_step_share");
  add_muscle(model, Muscle{ "strand", 1e6 * file.number("stress", "MPa"), true, true }, along_x);
  hold_face(model, 0, false);
  hold_face(model, 0, true, "grip");
  GuardedTrial motion(settings, trial, model);
  const RigidTransform drawn = shifted(1e-3 * file.number("drawn_by", "mm"), 0, 0);
  const double draw = file.seconds("draw"), switched = file.seconds("switch");
  motion.play_and_release({ { draw, motion.controls(0, drawn), 10 },
                            { switched, motion.controls(1, drawn), 1 },
                            { file.seconds("pull"), motion.controls(1, drawn), 10 },
                            { switched, motion.controls(0, drawn), 1 },
                            { draw, motion.controls(), 10 },
                            { file.seconds("rest"), motion.controls(), 10 } },
                          "drawn by 60 % while its muscle is switched on", file, "stiffening",
                          "A stiffening bar drawn by 60 % in 2 ms, its muscle switched on and off");
}

void mass_scaling(const StabilitySettings& settings, const CaseFile& file, Trial& trial)
{
  const auto make = [&file](double factor)
  {
    Model model = cantilever(file, 0.49);
    add_muscle(model, Muscle{ "strand", 1e3 * file.number("stress", "kPa"), false, true }, along_x);
    model.damping = file.number("damping", "1/s");
    if (factor > 1)
      model.mass_scaling = { MassScalingSettings::Kind::uniform, factor, {}, 0 };
    return model;
  };
  Vectors expected;
  for (const double factor : { 1.0, file.number("factor") })
  {
    GuardedTrial motion(settings, trial, make(factor));
    const double seconds = file.seconds("swing") * std::sqrt(factor);
    motion.advance(file.seconds("switch"), motion.controls(1), 1);
    motion.advance(seconds, motion.controls(1), 20);
    motion.check_balance(file, "masses by " + readable(factor));
    if (factor > 1)
      motion.plot("mass_scaling", "Masses scaled by 10⁴: a muscle is switched on under gravity");
    motion.settle(motion.controls(1), 1e-4, file.seconds("longest_settling") * std::sqrt(factor));
    if (factor > 1)
      trial.checks.absolute("off the equilibrium without scaling", "um", 0,
                            1e6 * farthest(motion.displacements(), expected), file.bound("equilibrium", "um"));
    expected = motion.displacements();
  }
}

}  // namespace

CaseFunctions hard_materials()
{
  return { { "near_incompressible", near_incompressible },
           { "stiffness_contrast", stiffness_contrast },
           { "thin_layer", thin_layer },
           { "stiffening", stiffening },
           { "mass_scaling", mass_scaling } };
}

}  // namespace frontalis
