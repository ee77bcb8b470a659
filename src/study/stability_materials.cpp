// what materials make hard: near-incompressibility, contrasts, thin layers, stiffening, scaled mass

#include "frontalis/study/equilibrium.hpp"
#include "stability_cases.hpp"
#include "stability_models.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

RigidTransform shifted(double x, double y, double z) { return { RigidTransform().rotation, { { x, y, z } } }; }

Model cantilever(double poisson)
{
  Model model = soft_block({ { 12, 4, 4 } });
  model.materials = { soft_tissue(poisson) };
  hold_face(model, 0, false);
  model.gravity = { { 0, 0, -9.81 } };
  return model;
}

double settled_tip(WatchedMotion& motion)
{
  motion.settle(motion.controls(), 1e-4, 5);
  const auto end = nodes_where(motion.model(), [](const auto& p) { return p[0] > 11.5e-3; });
  return 1e3 * mean_displacement(motion.displacements(), end)[2];
}

void near_incompressible(const StabilitySettings& settings, Trial& trial)
{
  WatchedMotion plain(settings, trial, cantilever(0.49));
  const double expected = settled_tip(plain);
  for (const double poisson : { 0.499, 0.4999 })
  {
    const std::string name = "ν = " + readable(poisson);
    WatchedMotion motion(settings, trial, cantilever(poisson));
    motion.advance(0.06, motion.controls(), 30);
    motion.expect_balance(name, 0.01);
    motion.plot("near_incompressible_" + std::to_string(std::lround(1e4 * poisson)),
                "A beam falls and swings, " + name);
    trial.checks.push_back(relative_check("tip's equilibrium, " + name, "mm", expected, settled_tip(motion), 0.03));
  }
}

void stiffness_contrast(const StabilitySettings& settings, Trial& trial)
{
  Model model = soft_block({ { 8, 4, 4 } });
  model.materials = { soft_tissue(), neo_hookean(24e6, 0.49), neo_hookean(48e6, 0.49), neo_hookean(81.4e3, 0.49) };
  // a chequerboard of tendon and fat, and voxels that are half corneum, half dermis
  mix(model,
      [&](std::size_t e) -> std::vector<std::pair<int, float>>
      {
        const auto& v = model.voxels[e];
        if (v[0] % 4 == 3)
          return { { 2, 0.5F }, { 3, 0.5F } };
        return { { (v[0] + v[1] + v[2]) % 2, 1.0F } };
      });
  model.damping = 50;
  hold_face(model, 0, false);
  hold_face(model, 0, true, "grip");
  WatchedMotion motion(settings, trial, model);
  motion.come_and_go({ { 5e-3, motion.controls(0, shifted(2e-3, 0, 0.5e-3)), 10 },
                       { 5e-3, motion.controls(), 10 },
                       { 10e-3, motion.controls(), 10 } },
                     "drawn by a quarter and back", 0.01, 0.02e-3, "stiffness_contrast",
                     "Tendon, fat and mixed voxels drawn by a quarter and back");
}

void thin_layer(const StabilitySettings& settings, Trial& trial)
{
  Model model = soft_block({ { 24, 2, 6 } });
  model.materials = { soft_tissue(), neo_hookean(48e6, 0.49), neo_hookean(81.4e3, 0.49) };
  mix(model,
      [&](std::size_t e) -> std::vector<std::pair<int, float>>
      {
        const auto depth = 5 - model.voxels[e][2];
        if (depth == 0)
          return { { 1, 0.02F }, { 2, 0.98F } };
        return depth == 1 ? std::vector<std::pair<int, float>>{ { 2, 0.8F }, { 0, 0.2F } }
                          : std::vector<std::pair<int, float>>{ { 0, 1.0F } };
      });
  model.damping = 50;
  hold_face(model, 0, false);
  hold_face(model, 0, true, "grip");
  WatchedMotion motion(settings, trial, model);
  const Controls drawn = motion.controls(0, shifted(-5e-3, 0, 0.2e-3)), back = motion.controls();
  motion.come_and_go({ { 20e-3, drawn, 10 }, { 20e-3, drawn, 10 }, { 20e-3, back, 10 }, { 20e-3, back, 10 } },
                     "shortened by a fifth and back", 0.01, 0.05e-3, "thin_layer",
                     "Skin with 0.02 mm of stratum corneum, shortened by a fifth and back");
}

void stiffening(const StabilitySettings& settings, Trial& trial)
{
  Model model = soft_block({ { 8, 3, 3 } });
  Material& tissue = model.materials[0];
  tissue.law = Law::fung;
  tissue.parameters[2] = 4;
  model.time_step_share = 0.99;
  model.damping = 50;
  add_muscles(model, { Muscle{ "strand", 0.3e6, true, true } },
              [](std::size_t) -> std::vector<Fibre> {
                return { { 0, { { 1, 0, 0 } } } };
              });
  hold_face(model, 0, false);
  hold_face(model, 0, true, "grip");
  WatchedMotion motion(settings, trial, model);
  const RigidTransform drawn = shifted(5e-3, 0, 0);
  motion.come_and_go({ { 2e-3, motion.controls(0, drawn), 10 },
                       { 1e-4, motion.controls(1, drawn), 1 },
                       { 5e-3, motion.controls(1, drawn), 10 },
                       { 1e-4, motion.controls(0, drawn), 1 },
                       { 2e-3, motion.controls(), 10 },
                       { 20e-3, motion.controls(), 10 } },
                     "drawn by 60 % while its muscle is switched on", 0.01, 0.05e-3, "stiffening",
                     "A stiffening bar drawn by 60 % in 2 ms, its muscle switched on and off");
}

void mass_scaling(const StabilitySettings& settings, Trial& trial)
{
  const auto make = [](double factor)
  {
    Model model = cantilever(0.49);
    add_muscles(model, { Muscle{ "strand", 5e3, false, true } },
                [](std::size_t) -> std::vector<Fibre> {
                  return { { 0, { { 1, 0, 0 } } } };
                });
    model.damping = 5;
    if (factor > 1)
      model.mass_scaling = { MassScalingSettings::Kind::uniform, factor, {}, 0 };
    return model;
  };
  Vectors expected;
  for (const double factor : { 1.0, 1e4 })
  {
    WatchedMotion motion(settings, trial, make(factor));
    const double seconds = 0.05 * std::sqrt(factor);
    motion.advance(1e-3, motion.controls(1), 1);
    motion.advance(seconds, motion.controls(1), 20);
    motion.expect_balance("masses by " + readable(factor), 0.01);
    if (factor > 1)
      motion.plot("mass_scaling", "Masses scaled by 10⁴: a muscle is switched on under gravity");
    motion.settle(motion.controls(1), 1e-4, 10 * std::sqrt(factor));
    if (factor > 1)
      trial.checks.push_back(absolute_check("off the equilibrium without scaling", "um", 0,
                                            1e6 * farthest(motion.displacements(), expected), 5));
    expected = motion.displacements();
  }
}

}  // namespace

std::vector<StabilityCase> hard_materials()
{
  return {
    { "near_incompressible", true, "Poisson ratios of 0.499 and 0.4999",
      "A beam of 12 × 4 × 4 voxels, held at one end, falls and swings under gravity, at Poisson's ratios of 0.499 and "
      "0.4999; then it comes to rest. Energy must be explained to 1 %, and the tip must come to rest within 3 % of "
      "where it does at 0.49: nothing locks. A time step from Young's modulus alone would be 41 times too long at "
      "0.4999.",
      near_incompressible },
    { "stiffness_contrast", true, "24 MPa beside 34 kPa, 48 MPa and 81 kPa in a voxel",
      "A chequerboard of tendon (24 MPa) and fat (34 kPa), every fourth plane half stratum corneum (48 MPa) and half "
      "dermis (81.4 kPa), is drawn by a quarter of its length in 5 ms and back. Energy explained to 1 %, at rest again "
      "in the end. The time step must be the stiffest voxel's, a 26th of fat's.",
      stiffness_contrast },
    { "thin_layer", true, "0.02 mm of stratum corneum on voxels of 1 mm",
      "Skin with 0.02 mm of stratum corneum mixed into its outer voxels, dermis and hypodermis, is shortened by a "
      "fifth and drawn back. Energy explained to 1 %, at rest again in the end. What is hard is that a fiftieth of a "
      "voxel has 600 times the stiffness of the rest.",
      thin_layer },
    { "stiffening", true, "0.99 of the critical step while voxels stiffen",
      "A bar of Fung's law (b = 4) is drawn by 60 % in 2 ms at 0.99 of the critical time step while a muscle along it, "
      "passive part included, is switched on and off at once. It must keep its energy explained to 1 % and be at rest "
      "in the end. With a bound that counts less than the exact slope of the exponential it ended in NaN, at 0.9 of "
      "the bound too; with the bound alone it loses or gains some percent: where voxels stiffen fast, steps are at "
      "most 0.55 of the critical one and every step is looked at.",
      stiffening },
    { "mass_scaling", true, "masses scaled by 10000",
      "A beam under gravity, a muscle switched on, with all masses times 10⁴ and without. Weight must not grow with "
      "mass: both come to rest in the same place, to 5 µm.",
      mass_scaling }
  };
}

}  // namespace frontalis
