#include "block_model.hpp"
#include "frontalis/physics/materials/lookup.hpp"
#include "frontalis/solver/solver.hpp"
#include "nodal_vectors.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace frontalis;
using test::Vectors;

namespace
{

Material material_of(Law law)
{
  Material m;
  m.name = "other";
  m.law = law;
  m.density = 1000;
  m.parameters = physics::example_of(law);
  return m;
}

// A block with rows of voxels of the given law, of neo-Hookean tissue, or of both.
Model mixed_block(Law law, const std::array<std::int32_t, 3>& voxels)
{
  test::BlockSettings s;
  s.voxels = voxels;
  s.damping = 500;
  Model model = test::block_model(s);
  model.materials.push_back(material_of(law));
  model.mixture_begin.assign(1, 0);
  model.mixture_material.clear();
  model.mixture_proportion.clear();
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    const float share = e % 3 == 0 ? 0.0f : e % 3 == 1 ? 0.3f : 1.0f;
    for (const std::int16_t m : { std::int16_t(0), std::int16_t(1) })
      if (const float proportion = m == 1 ? share : 1 - share; proportion > 0)
      {
        model.mixture_material.push_back(m);
        model.mixture_proportion.push_back(proportion);
      }
    model.mixture_begin.push_back(static_cast<std::int32_t>(model.mixture_material.size()));
  }
  return model;
}

// A muscle in all voxels.
void add_strand(Model& model)
{
  Muscle muscle;
  muscle.name = "strand";
  muscle.stress_reference = 20e3;
  muscle.passive = true;
  test::add_muscle(model, { { 0.8f, 0, 0.6f } }, muscle);
}

std::string law_name(const testing::TestParamInfo<std::tuple<Backend, Law>>& info)
{
  return std::get<0>(info.param) + "_" + physics::description_of(std::get<1>(info.param)).name;
}

}  // namespace

class Laws : public testing::TestWithParam<std::tuple<Backend, Law>>
{
protected:
  std::unique_ptr<Solver> solver(const Model& model) const
  {
    return make_solver(std::make_shared<const Model>(model), { std::get<0>(GetParam()), 2, 0 });
  }
};

TEST_P(Laws, ForcesAreTheGradientOfTheEnergy)
{
  const Model model = mixed_block(std::get<1>(GetParam()), { { 5, 2, 2 } });
  test::expect_forces_from_energy(model, *solver(model), test::random_vectors(model, 1.5e-4, 7));
}

// If a body with muscle everywhere is rotated as a whole, its forces rotate with it.
// The energy of a mixture of neo-Hookean materials is the sum of their energies, also if one stiffens.
TEST(NeoHookeanMixture, HasTheEnergyOfItsParts)
{
  std::array<double, 3> energy{};
  for (std::size_t part = 0; part < energy.size(); ++part)
  {
    Model model = test::block_model({});
    model.materials.push_back(model.materials[0]);
    for (double& parameter : model.materials[1].parameters)
      parameter *= 3;
    model.materials[1].parameters[physics::slot_of(1)] = 1;
    const float share = part == 0 ? 0.25F : part == 1 ? 0.0F : 1.0F;
    model.mixture_begin.assign(1, 0);
    model.mixture_material.clear();
    model.mixture_proportion.clear();
    for (std::size_t e = 0; e < model.voxels.size(); ++e)
    {
      model.mixture_material.insert(model.mixture_material.end(), { 0, 1 });
      model.mixture_proportion.insert(model.mixture_proportion.end(), { 1 - share, share });
      model.mixture_begin.push_back(static_cast<std::int32_t>(model.mixture_material.size()));
    }
    const auto solver = make_solver(std::make_shared<const Model>(model), { "reference", 1 });
    Vectors u(model.nodes.size());
    for (std::size_t n = 0; n < u.size(); ++n)
      u[n][0] = 1e-3 * model.nodes[n][1];  // a simple shear of one edge per edge
    solver->set_displacements(u);
    energy[part] = solver->monitor().internal;
  }
  EXPECT_NEAR(energy[2] / energy[1], 3 * 1.5, 1e-6) << "the invariant has grown by 1";
  EXPECT_NEAR(energy[0] / energy[1], 0.75 + 0.25 * 4.5, 1e-6);
}

TEST_P(Laws, ForcesTurnWithTheBody)
{
  const double a = 0.9, c = std::cos(a), s = std::sin(a);
  const double Q[3][3] = { { 0.36 + 0.64 * c, 0.48 * (1 - c), 0.8 * s },
                           { 0.48 * (1 - c), 0.64 + 0.36 * c, -0.6 * s },
                           { -0.8 * s, 0.6 * s, c } };
  for (const auto hourglass : { HourglassControl::scalar, HourglassControl::assumed_strain })
  {
    Model model = mixed_block(std::get<1>(GetParam()), { { 5, 2, 2 } });
    model.hourglass = hourglass;
    add_strand(model);
    const auto solver_ = solver(model);
    solver_->advance(1e-9, { { 0.7f }, {} });
    const Vectors u = test::random_vectors(model, 1.5e-4, 7);
    Vectors turned = u, f, f_turned;
    for (std::size_t n = 0; n < u.size(); ++n)
    {
      const auto X = test::rest(model, n);
      for (int i = 0; i < 3; ++i)
      {
        turned[n][i] = -X[i];
        for (int j = 0; j < 3; ++j)
          turned[n][i] += Q[i][j] * (X[j] + u[n][j]);
      }
    }
    solver_->set_displacements(u);
    solver_->internal_forces(f);
    solver_->set_displacements(turned);
    solver_->internal_forces(f_turned);
    double largest = 0, error = 0;
    for (std::size_t n = 0; n < u.size(); ++n)
      for (int i = 0; i < 3; ++i)
      {
        double expected = 0;
        for (int j = 0; j < 3; ++j)
          expected += Q[i][j] * f[n][j];
        largest = std::max(largest, std::abs(expected));
        error = std::max(error, std::abs(f_turned[n][i] - expected));
      }
    // Rounding displacements of millimetres to floats changes the strain by 1e-7, which the bulk modulus multiplies.
    EXPECT_LT(error / largest, std::get<0>(GetParam()) == "reference" ? 1e-9 : 1e-4);
  }
}

TEST_P(Laws, AVoxelsOwnDirectionsGoBeforeTheMaterials)
{
  const Law law = std::get<1>(GetParam());
  Model own = mixed_block(law, { { 5, 2, 2 } }), turned = own;
  turned.materials[1].parameters[physics::first_direction] = 0;
  turned.materials[1].parameters[physics::first_direction + 1] = 0.6;
  turned.materials[1].parameters[physics::first_direction + 2] = 0.8;
  own.material_directions.assign(own.voxels.size(), { 0, 0.6f, 0.8f, 0, 0, 0 });
  const Vectors u = test::random_vectors(own, 1.5e-4, 7);
  Vectors f[2];
  for (const auto& [model, out] : { std::pair{ &own, &f[0] }, { &turned, &f[1] } })
  {
    const auto s = solver(*model);
    s->set_displacements(u);
    s->internal_forces(*out);
  }
  double largest = 0;
  for (const auto& v : f[1])
    for (const double c : v)
      largest = std::max(largest, std::abs(c));
  for (std::size_t n = 0; n < u.size(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      ASSERT_NEAR(f[0][n][axis], f[1][n][axis], 1e-5 * largest);
}

TEST_P(Laws, ComesBackToRestFromALargeDistortion)
{
  const Model model = mixed_block(std::get<1>(GetParam()), { { 6, 3, 3 } });
  const auto solver_ = solver(model);
  // Moves every node by up to 0.4 voxels, so that some voxels keep little more than half of their volume.
  solver_->set_displacements(test::random_vectors(model, 4e-4, 7));
  const Monitor before = solver_->monitor();
  for (int i = 0; i < 10; ++i)
    solver_->advance(5e-3, {});
  const Monitor after = solver_->monitor();
  EXPECT_TRUE(after.finite);
  EXPECT_LT(after.internal + after.hourglass + after.kinetic, 1e-3 * (before.internal + before.hourglass));
  EXPECT_NEAR(after.worst_jacobian, 1, 0.01);
}

// Nodes pass each other, so that voxels are crushed flat and inverted, while a muscle pulls in all voxels.
TEST_P(Laws, CrushedAndInvertedVoxelsPushBack)
{
  for (const auto integration : { Integration::one_point, Integration::selective_reduced })
    for (const double activation : { 0.0, 1.0 })
    {
      Model model = mixed_block(std::get<1>(GetParam()), { { 6, 3, 3 } });
      model.integration = integration;
      add_strand(model);
      const auto solver_ = solver(model);
      solver_->advance(1e-9, { { static_cast<float>(activation) }, {} });
      const Vectors u = test::random_vectors(model, 1.2e-3, 7);
      solver_->set_displacements(u);
      EXPECT_LT(solver_->monitor().worst_jacobian, -0.2);
      Vectors f;
      solver_->internal_forces(f);
      double work = 0;
      for (std::size_t n = 0; n < u.size(); ++n)
        for (int axis = 0; axis < 3; ++axis)
        {
          ASSERT_TRUE(std::isfinite(f[n][axis])) << n << " " << axis;
          work += f[n][axis] * u[n][axis];
        }
      // Voxels that return to rest do work.
      EXPECT_GT(work, 0);
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, Laws,
                         testing::Combine(testing::ValuesIn(available_backends()),
                                          testing::ValuesIn(physics::every_law)),
                         law_name);
