#include "block_model.hpp"
#include "frontalis/error.hpp"
#include "frontalis/solver/solver.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace frontalis
{
namespace
{

using Vectors = std::vector<std::array<double, 3>>;

enum Effect : unsigned
{
  viscosity = 1,
  other_law = 2,
  contraction = 4,
  passive_fibres = 8,
  gravity = 16,
  pressure = 32,
  prescribed = 64,
  sliding = 128,
  all_effects = 256
};

// strips of several lengths, so that tiles are full, half full and empty in places; each effect has its own part of it
Model scene_of(unsigned effects, HourglassControl hourglass = HourglassControl::scalar,
               Integration integration = Integration::one_point)
{
  test::BlockSettings settings;
  settings.voxels = { { 11, 3, 3 } };
  settings.damping = 20;
  settings.keep = [](std::int32_t i, std::int32_t j, std::int32_t k) { return i < 11 - 2 * j || k == 1; };
  Model model = test::block_model(settings);
  model.hourglass = hourglass;
  model.integration = integration;
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    if (model.nodes[n][0] == 0)
      model.rigid.push_back({ static_cast<std::int32_t>(n), -1 });
  if (effects & other_law)
  {
    Material other = model.materials[0];
    other.law = Law::mooney_rivlin;
    other.parameters[0] /= 4;
    other.parameters[2] = other.parameters[0];
    model.materials.push_back(other);
  }
  if (effects & viscosity)
  {
    model.materials.back().viscous_share = { { 0.4, 0.2 } };
    model.materials.back().viscous_time = { { 2e-4, 1e-2 } };
  }
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
    if (model.voxels[e][0] > 6)
      model.mixture_material[e] = static_cast<std::int16_t>(model.materials.size() - 1);
  if (effects & (contraction | passive_fibres))
  {
    Muscle muscle;
    muscle.name = "strand";
    muscle.stress_reference = 20e3;
    muscle.passive = effects & passive_fibres;
    test::add_muscle(model, { { 0.8f, 0.6f, 0 } }, muscle);
    for (float& weight : model.fibre_weight)
      weight = 0.5f;
  }
  if (effects & gravity)
    model.gravity = { { 1, -2, 9.81 } };
  if (effects & pressure)
  {
    Load press;
    press.name = "press";
    press.kind = Load::Kind::pressure;
    press.value = { { 500, 0, 0 } };
    press.mesh.vertices = { { { 2e-3, 0, 3e-3 } }, { { 4e-3, 0, 3e-3 } }, { { 3e-3, 2e-3, 3e-3 } } };
    press.mesh.triangles = { { { 0, 1, 2 } } };
    for (const auto& corner : press.mesh.vertices)
      for (std::size_t e = 0; e < model.voxels.size(); ++e)
        if (model.voxels[e] == std::array<std::int32_t, 3>{ { static_cast<std::int32_t>(corner[0] * 1e3 + 0.5),
                                                              static_cast<std::int32_t>(corner[1] * 1e3 + 0.5), 2 } })
        {
          press.binding.voxel.push_back(static_cast<std::int32_t>(e));
          press.binding.coordinates.push_back({ { 0, 0, 1 } });
        }
    model.loads.push_back(press);
  }
  if (effects & prescribed)
  {
    Load pull;
    pull.name = "pull";
    pull.kind = Load::Kind::displacement;
    pull.value = { { 0, 3e-4, 0 } };
    pull.fixed = { { false, true, false } };
    pull.ramp = 1e-3;
    for (std::size_t n = 0; n < model.nodes.size(); ++n)
      if (model.nodes[n][0] == 11)
        model.prescribed.push_back({ static_cast<std::int32_t>(n), static_cast<std::int32_t>(model.loads.size()) });
    model.loads.push_back(pull);
  }
  if (effects & sliding)
  {
    ConstraintSurface floor;
    floor.name = "floor";
    floor.mesh.vertices = { { { -1, -1, 0 } }, { { 1, -1, 0 } }, { { 1, 1, 0 } }, { { -1, 1, 0 } } };
    floor.mesh.triangles = { { { 0, 1, 2 } }, { { 0, 2, 3 } } };
    model.constraint_surfaces.push_back(floor);
    for (std::size_t n = 0; n < model.nodes.size(); ++n)
      if (model.nodes[n][2] == 0 && model.nodes[n][0] > 0 && model.nodes[n][0] < 9)
        model.sliding.push_back({ static_cast<std::int32_t>(n), 0, 0 });
  }
  return model;
}

Vectors motion(const Model& model, Backend backend, int threads, bool active, const char* instructions = nullptr)
{
  if (instructions != nullptr)
    ::setenv("FRONTALIS_INSTRUCTION_SET", instructions, 1);
  std::unique_ptr<Solver> solver;
  try
  {
    solver = make_solver(std::make_shared<const Model>(model), { backend, threads, 4e-6 });
  }
  catch (const Error&)
  {
    ::unsetenv("FRONTALIS_INSTRUCTION_SET");
    throw;
  }
  ::unsetenv("FRONTALIS_INSTRUCTION_SET");
  Controls controls = solver->controls();
  std::fill(controls.activation.begin(), controls.activation.end(), active ? 0.7f : 0.0f);
  solver->advance(8e-4, controls);
  Vectors u;
  solver->displacements(u);
  return u;
}

double difference(const Vectors& a, const Vectors& b)
{
  double worst = 0, largest = 1e-6;
  for (std::size_t n = 0; n < a.size(); ++n)
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      worst = std::max(worst, std::abs(a[n][axis] - b[n][axis]));
      largest = std::max(largest, std::abs(b[n][axis]));
    }
  return worst / largest;
}

std::vector<const char*> instruction_sets()
{
  std::vector<const char*> sets;
  for (const char* set : { "baseline", "avx2", "avx512" })
    try
    {
      motion(scene_of(0), Backend::cpu, 1, false, set);
      sets.push_back(set);
    }
    catch (const Error&)
    {
      // not on this machine
    }
  return sets;
}

// no effect is dropped where another is there too
TEST(Effects, every_combination_moves_like_the_reference)
{
  std::vector<Backend> backends = available_backends();
  for (unsigned effects = 0; effects < all_effects; ++effects)
  {
    const Model model = scene_of(effects);
    const bool active = effects & contraction;
    const Vectors expected = motion(model, Backend::reference, 1, active);
    for (const Backend backend : backends)
      EXPECT_LT(difference(motion(model, backend, 2, active), expected), 2e-3) << name_of(backend) << " " << effects;
  }
}

TEST(Effects, every_form_of_element_on_every_instruction_set_in_float_and_double)
{
  const auto sets = instruction_sets();
  ASSERT_FALSE(sets.empty());
  for (const auto hourglass : { HourglassControl::scalar, HourglassControl::assumed_strain })
    for (const auto integration : { Integration::one_point, Integration::selective_reduced })
    {
      Model model = scene_of(all_effects - 1, hourglass, integration);
      const Vectors expected = motion(model, Backend::reference, 1, true);
      for (const auto precision : { Precision::single, Precision::compensated, Precision::double_precision })
      {
        model.precision = precision;
        for (const char* set : sets)
        {
          const Vectors one = motion(model, Backend::cpu, 1, true, set);
          EXPECT_LT(difference(one, expected), precision == Precision::double_precision ? 1e-5 : 2e-3) << set;
          for (const int threads : { 2, 4 })
            EXPECT_EQ(one, motion(model, Backend::cpu, threads, true, set)) << set << ", " << threads << " threads";
        }
      }
    }
}

}  // namespace
}  // namespace frontalis
