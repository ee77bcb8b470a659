// Strain and stress of the skin and inside the tissue: they agree with known values, and those of the skin are computed
// only on request.

#include "backends.hpp"
#include "block_model.hpp"
#include "frontalis/error.hpp"
#include "frontalis/model/effects.hpp"
#include "frontalis/solver/tissue_state.hpp"

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

// The same with a muscle along z.
Model block_with_muscle()
{
  Model model = block_with_skin();
  Muscle muscle;
  muscle.name = "pull";
  muscle.stress_reference = 10e3;
  test::add_muscle(model, { { 0, 0, 1 } }, muscle);
  return model;
}

std::vector<std::array<double, 3>> stretched(const Model& model, double stretch)
{
  std::vector<std::array<double, 3>> u;
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    u.push_back({ { 0, 0, (stretch - 1) * test::rest(model, n)[2] } });
  return u;
}

// Activates the muscle, whose tissue keeps its shape.
void pull(Solver& solver, const Model& model)
{
  Controls controls = solver.controls();
  controls.activation[0] = 1;
  solver.advance(0, controls);
  solver.advance(solver.time_step(), controls);
  solver.set_displacements(stretched(model, 1));
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
  const Model model = block_with_muscle();
  const auto solver = this->solver(model);
  pull(*solver, model);
  std::vector<float> field;
  solver->skin_field(SkinField::stress, field);
  for (const float stress : field)
    EXPECT_NEAR(stress, 10e3, 10);
  solver->switch_effect(Effect::contraction, false);
  solver->skin_field(SkinField::stress, field);
  for (const float stress : field)
    EXPECT_NEAR(stress, 0, 1e-3);
}

// The block's z axis is the face's x axis.
TEST_P(SkinFields, have_a_tissue_below_them_whose_state_is_in_the_face_frame)
{
  Model model = block_with_muscle();
  model.to_face.rotation = { { 0, 0, 1, 1, 0, 0, 0, 1, 0 } };
  model.to_face.translation = { { 0.1, 0, 0 } };
  const auto solver = this->solver(model);
  const double stretch = 1.2;
  solver->set_displacements(stretched(model, stretch));
  TissueReader reader(model);
  TissueState state;
  reader.read(*solver, state);
  ASSERT_EQ(state.place.size(), model.nodes.size());
  for (std::size_t n = 0; n < state.place.size(); ++n)
  {
    const auto rest = test::rest(model, n);
    EXPECT_NEAR(state.place[n][0], 0.1 + stretch * rest[2], 1e-7);
    EXPECT_NEAR(state.place[n][1], rest[0], 1e-7);
    EXPECT_NEAR(state.displacement[n][0], (stretch - 1) * rest[2], 1e-7);
    EXPECT_NEAR(state.displacement[n][1], 0, 1e-9);
  }
  // As for the skin.
  const double difference = test::shear_modulus({}) * std::pow(stretch, -5.0 / 3) * (stretch * stretch - 1);
  ASSERT_EQ(state.stress.size(), model.voxels.size());
  for (std::size_t e = 0; e < state.stress.size(); ++e)
  {
    const auto& [xx, yy, zz, xy, yz, xz] = state.stress[e];
    EXPECT_NEAR(xx - yy, difference, 1e-3 * difference);
    EXPECT_NEAR(yy, zz, 1e-3 * difference);
    EXPECT_NEAR(std::abs(xy) + std::abs(yz) + std::abs(xz), 0, 1e-3 * difference);
    EXPECT_NEAR(state.von_mises[e], difference, 1e-3 * difference);
    EXPECT_NEAR(state.strain[e][0], 0.5 * (stretch * stretch - 1), 1e-5);
    EXPECT_NEAR(state.strain[e][1], 0, 1e-6);
    EXPECT_NEAR(state.volume_ratio[e], stretch, 1e-5);
    EXPECT_NEAR(state.fibre_stretch[e], stretch, 1e-5);
  }
}

TEST_P(SkinFields, show_the_pull_of_fibres_inside_the_tissue)
{
  const Model model = block_with_muscle();
  const auto solver = this->solver(model);
  pull(*solver, model);
  TissueReader reader(model);
  TissueState state;
  reader.read(*solver, state);
  for (const auto& stress : state.stress)
    EXPECT_NEAR(stress[2] - stress[0], 10e3, 10);
  solver->switch_effect(Effect::contraction, false);
  reader.read(*solver, state);
  for (const float stress : state.von_mises)
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
