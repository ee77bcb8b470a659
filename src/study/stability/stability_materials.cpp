// Hard cases of materials: near-incompressibility, contrasts, thin layers, stiffening, scaled mass.

#include "frontalis/physics/materials/all.hpp"
#include "frontalis/study/statics.hpp"
#include "study/stability/stability_cases.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

// The translation `drawn_by` of the file, which is in mm.
RigidTransform drawn_by(const CaseRun& run)
{
  const std::vector<double> by = run.numbers("drawn_by", "mm", 3);
  return shifted({ { 1e-3 * by[0], 1e-3 * by[1], 1e-3 * by[2] } });
}

Model cantilever(const CaseRun& run, double poisson)
{
  Model model = voxel_model(run.size(), 1e-3, soft_tissue(poisson));
  hold_face(model, 0, false);
  model.gravity = { { 0, 0, -9.81 } };
  return model;
}

// A block whose face x = 0 is fixed and whose opposite face is moved by the bone "grip".
Model gripped_block(const CaseRun& run, const std::vector<Material>& materials)
{
  Model model = damped_block(run);
  model.materials = materials;
  hold_ends(model, 0, "grip");
  return model;
}

// Mean vertical displacement of the free end at equilibrium [mm].
double settled_tip(GuardedTrial& motion)
{
  motion.settle(motion.controls());
  const double last = 1e-3 * (motion.model().size[0] - 0.5);
  const auto end = nodes_where(motion.model(), [&](const auto& p) { return p[0] > last; });
  return 1e3 * mean_displacement(motion.displacements(), end)[2];
}

void near_incompressible(CaseRun& run)
{
  GuardedTrial plain(run, cantilever(run, run.number("poisson_ratio_of_the_expected")));
  const double expected = settled_tip(plain);
  for (const double poisson : run.numbers("poisson_ratios"))
  {
    const std::string name = "ν = " + readable(poisson);
    GuardedTrial motion(run, cantilever(run, poisson));
    motion.advance({ run.seconds("swing"), motion.controls(), 30 });
    motion.check_balance(name, fmt::format("near_incompressible_{}", std::lround(1e4 * poisson)),
                         "A beam falls and swings, " + name);
    run.check_relative("tip's equilibrium, " + name, "mm", expected, settled_tip(motion), "tip");
  }
}

void stiffness_contrast(CaseRun& run)
{
  Model model = gripped_block(run, { soft_tissue(), neo_hookean(1e6 * run.number("tendon", "MPa"), 0.49),
                                     neo_hookean(1e6 * run.number("corneum", "MPa"), 0.49),
                                     neo_hookean(1e3 * run.number("dermis", "kPa"), 0.49) });
  // A chequerboard of tendon and fat; every fourth plane of voxels is half corneum and half dermis.
  mix(model,
      [&](std::size_t e) -> Mixture
      {
        const auto& v = model.voxels[e];
        if (v[0] % 4 == 3)
          return { { 2, 0.5F }, { 3, 0.5F } };
        return { { (v[0] + v[1] + v[2]) % 2, 1.0F } };
      });
  GuardedTrial motion(run, model);
  motion.play_and_release({ { run.seconds("draw"), motion.controls(0, drawn_by(run)), 10 },
                            { run.seconds("back"), motion.controls(), 10 },
                            { run.seconds("rest"), motion.controls(), 10 } },
                          "drawn by a quarter and back", "stiffness_contrast",
                          "Tendon, fat and mixed voxels drawn by a quarter and back");
}

void thin_layer(CaseRun& run)
{
  Model model = gripped_block(run, { soft_tissue(), neo_hookean(1e6 * run.number("corneum", "MPa"), 0.49),
                                     neo_hookean(1e3 * run.number("dermis", "kPa"), 0.49) });
  const auto corneum = static_cast<float>(run.number("corneum_of_a_voxel"));
  mix(model,
      [&](std::size_t e) -> Mixture
      {
        const auto depth = model.size[2] - 1 - model.voxels[e][2];
        if (depth == 0)
          return { { 1, corneum }, { 2, 1 - corneum } };
        return depth == 1 ? Mixture{ { 2, 0.8F }, { 0, 0.2F } } : Mixture{ { 0, 1.0F } };
      });
  GuardedTrial motion(run, model);
  const Controls drawn = motion.controls(0, drawn_by(run)), back = motion.controls();
  const double phase = run.seconds("draw");
  motion.play_and_release({ { phase, drawn, 10 }, { phase, drawn, 10 }, { phase, back, 10 }, { phase, back, 10 } },
                          "shortened by a fifth and back", "thin_layer",
                          "Skin with 0.02 mm of stratum corneum, shortened by a fifth and back");
}

void stiffening(CaseRun& run)
{
  Model model = gripped_block(run, { soft_tissue() });
  Material& tissue = model.materials[0];
  tissue.law = law_of<physics::FungExponential>;
  tissue.parameters[2] = run.number("exponent");
  model.time_step_share = run.number("time_step_share");
  add_muscle(model, Muscle{ "strand", 1e6 * run.number("stress", "MPa"), true, true }, along_x);
  GuardedTrial motion(run, model);
  const RigidTransform drawn = shifted({ { 1e-3 * run.number("drawn_by", "mm"), 0, 0 } });
  const double draw = run.seconds("draw"), switched = run.seconds("switch");
  motion.play_and_release({ { draw, motion.controls(0, drawn), 10 },
                            { switched, motion.controls(1, drawn), 1 },
                            { run.seconds("pull"), motion.controls(1, drawn), 10 },
                            { switched, motion.controls(0, drawn), 1 },
                            { draw, motion.controls(), 10 },
                            { run.seconds("rest"), motion.controls(), 10 } },
                          "drawn by 60 % while its muscle is switched on", "stiffening",
                          "A stiffening bar drawn by 60 % in 2 ms, its muscle switched on and off");
}

void mass_scaling(CaseRun& run)
{
  Model model = cantilever(run, 0.49);
  add_muscle(model, Muscle{ "strand", 1e3 * run.number("stress", "kPa"), false, true }, along_x);
  model.damping = run.number("damping", "1/s");
  Vectors expected;
  for (const double factor : { 1.0, run.number("factor") })
  {
    if (factor > 1)
      model.mass_scaling = { MassScalingSettings::Kind::uniform, factor, {}, 0 };
    GuardedTrial motion(run, model);
    motion.advance({ run.seconds("switch"), motion.controls(1) });
    motion.advance({ run.seconds("swing") * std::sqrt(factor), motion.controls(1), 20 });
    motion.check_balance("masses by " + readable(factor));
    if (factor > 1)
      motion.plot("mass_scaling", "Masses scaled by 10⁴: a muscle is switched on under gravity");
    motion.settle(motion.controls(1), std::sqrt(factor));
    if (factor > 1)
      run.check("distance from the equilibrium without scaling", "um", 0,
                1e6 * farthest(motion.displacements(), expected), "equilibrium");
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
