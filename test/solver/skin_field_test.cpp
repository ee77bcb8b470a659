// Strain and stress of the skin: they agree with known values and are computed only on request.

#include "backends.hpp"
#include "block_model.hpp"
#include "frontalis/error.hpp"
#include "frontalis/model/effects.hpp"

#include <cmath>

namespace frontalis
{
namespace
{

// A block whose skin is one triangle on its top; one corner of the triangle is outside the block.
Model block_with_skin()
{
  Model model = test::block_model();
  model.skin.vertices = { { { 1e-3, 1e-3, 4e-3 } }, { { 3e-3, 1e-3, 4e-3 } }, { { 2e-3, 3e-3, 4.5e-3 } } };
  model.skin.triangles = { { { 0, 1, 2 } } };
  for (const auto& voxel : { std::array<std::int32_t, 3>{ { 1, 1, 3 } }, { { 2, 1, 3 } }, { { 1, 2, 3 } } })
    for (std::size_t e = 0; e < model.voxels.size(); ++e)
      if (model.voxels[e] == voxel)
        model.skin_binding.voxel.push_back(static_cast<std::int32_t>(e));
  model.skin_binding.coordinates = { { { 0, 0, 1 } }, { { 1, 0, 1 } }, { { 1, 1, 1.5f } } };
  return model;
}

std::vector<std::array<double, 3>> stretched(const Model& model, double stretch)
{
  std::vector<std::array<double, 3>> u;
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    u.push_back({ { 0, 0, (stretch - 1) * test::rest(model, n)[2] } });
  return u;
}

std::size_t bytes_of_fields(const Solver& solver)
{
  std::size_t bytes = 0;
  for (const Allocation& a : solver.allocations())
    bytes += a.effect == Effect::output_fields ? a.bytes : 0;
  return bytes;
}

class SkinFields : public test::EveryBackend
{
};

TEST_P(SkinFields, are_those_of_a_uniform_stretch)
{
  const Model model = block_with_skin();
  const auto solver = this->solver(model);
  const double stretch = 1.2;
  solver->set_displacements(stretched(model, stretch));
  std::vector<float> field;
  solver->skin_field(SkinField::strain, field);
  ASSERT_EQ(field.size(), 3U);
  for (const float strain : field)
    EXPECT_NEAR(strain, 0.5 * (stretch * stretch - 1), 1e-5);
  solver->skin_field(SkinField::stress, field);
  // For the neo-Hookean law with isochoric split, s_zz - s_xx = mu J^(-5/3) (stretch^2 - 1).
  const double expected = test::shear_modulus({}) * std::pow(stretch, -5.0 / 3) * (stretch * stretch - 1);
  for (const float stress : field)
    EXPECT_NEAR(stress, expected, 1e-3 * expected);
}

TEST_P(SkinFields, have_the_stress_of_fibres_that_pull)
{
  Model model = block_with_skin();
  Muscle muscle;
  muscle.name = "pull";
  muscle.stress_reference = 10e3;
  test::add_muscle(model, { { 0, 0, 1 } }, muscle);
  const auto solver = this->solver(model);
  Controls controls = solver->controls();
  controls.activation[0] = 1;
  solver->advance(0, controls);
  solver->advance(solver->time_step(), controls);
  solver->set_displacements(stretched(model, 1));
  std::vector<float> field;
  solver->skin_field(SkinField::stress, field);
  for (const float stress : field)
    EXPECT_NEAR(stress, 10e3, 10);
  solver->switch_effect(Effect::contraction, false);
  solver->skin_field(SkinField::stress, field);
  for (const float stress : field)
    EXPECT_NEAR(stress, 0, 1e-3);
}

TEST_P(SkinFields, cost_nothing_until_they_are_asked_for)
{
  const auto solver = this->solver(block_with_skin());
  const Controls controls = solver->controls();
  solver->advance(1e-4, controls);
  SkinState skin;
  solver->skin(skin);
  EXPECT_EQ(bytes_of_fields(*solver), 0U);
  std::vector<float> field;
  solver->skin_field(SkinField::strain, field);
  EXPECT_GT(bytes_of_fields(*solver), 0U);
}

TEST_P(SkinFields, are_refused_where_the_scene_has_none)
{
  Model model = block_with_skin();
  switch_off(model, EffectSet().with(Effect::output_fields));
  std::vector<float> field;
  try
  {
    solver(model)->skin_field(SkinField::strain, field);
    FAIL();
  }
  catch (const Error& error)
  {
    EXPECT_STREQ(error.what(), "the model has no output_fields: switched off by the scene");
  }
  EXPECT_THROW(skin_field_from_name("temperature"), Error);
}

FRONTALIS_EVERY_BACKEND(SkinFields);

}  // namespace
}  // namespace frontalis
