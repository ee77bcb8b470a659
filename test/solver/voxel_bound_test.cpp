#include "block_model.hpp"
#include "physics/deformation.hpp"
#include "true_frequency.hpp"

#include "frontalis/physics/materials/lookup.hpp"
#include "frontalis/solver/solver.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>
#include <random>

using namespace frontalis;
using test::Vectors;

namespace
{

using physics::test::Matrix;
using physics::test::operator*;

// A random deformation with stretches from 1 / `most` to `most`. Three out of four keep the volume to within 2 %.
Matrix random_gradient(std::mt19937& random, double most, int index)
{
  std::uniform_real_distribution<double> value(-1, 1);
  double stretch[3], J = 1;
  for (double& s : stretch)
  {
    s = std::pow(most, value(random));
    J *= s;
  }
  const double scale = index % 4 == 0 ? 1 : (1 + 0.02 * value(random)) / std::cbrt(J);
  const Matrix first = physics::test::random_rotation(random), last = physics::test::random_rotation(random);
  return last * (physics::test::diagonal(scale * stretch[0], scale * stretch[1], scale * stretch[2]) * first);
}

// The true largest eigenvalue of a single voxel, divided by its bound.
double true_over_bound(const Model& model, const Matrix& F)
{
  Vectors u(8);
  for (std::size_t n = 0; n < 8; ++n)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        u[n][i] += (F.a[i][j] - (i == j ? 1 : 0)) * test::rest(model, n)[j];
  std::vector<std::size_t> free(24);
  std::iota(free.begin(), free.end(), 0);
  return test::true_over_bound(model, u, std::vector<double>(8, model.materials[0].density * 1e-9 / 8), free);
}

struct Tissue
{
  const char* name;
  Law law;
  double poisson;
  physics::MaterialNumbers own;  // nonzero parameters replace those of the block's material
  double allowed;
  double least = 0.9;  // of the worst ratio: smaller ones are far too careful
};
constexpr double mu = 34e3 / 2.98;

class TimeStepBound : public testing::TestWithParam<Tissue>
{
};

}  // namespace

TEST_P(TimeStepBound, holds_for_a_deformed_voxel)
{
  const Tissue& tissue = GetParam();
  test::BlockSettings settings;
  settings.voxels = { { 1, 1, 1 } };
  settings.poisson = tissue.poisson;
  Model model = test::block_model(settings);
  Material& material = model.materials[0];
  material.law = tissue.law;
  for (std::size_t p = 0; p < tissue.own.size(); ++p)
    if (tissue.own[p] != 0)
      material.parameters[p] = tissue.own[p];
  std::mt19937 random(5);
  double worst = 0;
  for (int i = 0; i < 120; ++i)
    worst = std::max(worst, true_over_bound(model, random_gradient(random, i % 2 == 0 ? 1.3 : 2, i)));
  EXPECT_LT(worst, tissue.allowed);
  EXPECT_GT(worst, tissue.least) << "far too careful";
}

TEST(FibreBound, holds_for_fibres_that_are_stretched_and_pressed)
{
  std::mt19937 random(7);
  for (const double tension : { 0.3e6, 5e6 })
    for (const bool passive : { false, true })
      for (const bool with_length : { false, true })
      {
        test::BlockSettings settings;
        settings.voxels = { { 1, 1, 1 } };
        settings.young = 0.5e6;
        Model model = test::block_model(settings);
        Muscle muscle;
        muscle.name = "muscle";
        muscle.stress_reference = tension;
        muscle.passive = passive;
        muscle.tension_length = with_length;
        test::add_muscle(model, { { 0.6f, 0, 0.8f } }, muscle);
        double worst = 0;
        for (int i = 0; i < 120; ++i)
          worst = std::max(worst, true_over_bound(model, random_gradient(random, i % 2 == 0 ? 1.3 : 2.5, i)));
        EXPECT_LT(worst, 1.01) << tension << " Pa, " << passive << with_length;
        EXPECT_GT(worst, 0.3) << "far too careful";
      }
}

INSTANTIATE_TEST_SUITE_P(
    Laws, TimeStepBound,
    testing::Values(
        Tissue{ "neo_hookean", Law::neo_hookean, 0.49, {}, 1.01 },
        Tissue{ "neo_hookean_stiffening", Law::neo_hookean, 0.49, { mu, 0, 3 }, 1.01 },
        Tissue{ "neo_hookean_compressible", Law::neo_hookean, 0.3, {}, 1.1 },
        Tissue{ "neo_hookean_nearly_incompressible", Law::neo_hookean, 0.4999, {}, 1.01 },
        Tissue{ "mooney_rivlin", law_of<physics::MooneyRivlin>, 0.49, { 0.25 * mu, 0, 0.25 * mu }, 1.01 },
        Tissue{ "ogden", law_of<physics::Ogden>, 0.49, { 0.5 * mu, 0, 2, -0.25 * mu, -4 }, 1.01 },
        Tissue{ "ogden_of_skin", law_of<physics::Ogden>, 0.49, { mu / 7, 0, 14, 0.01 * mu, 2 }, 1.02 },
        Tissue{ "fung", law_of<physics::FungExponential>, 0.49, { 0, 0, 4 }, 1.02 },
        Tissue{ "holzapfel", law_of<physics::HolzapfelGasserOgden>, 0.49, { mu, 0, mu, 5, 0, 1, 0, 0, 0, 1, 0 }, 1.02 },
        Tissue{ "fibrous",
                law_of<physics::HolzapfelGasserOgden>,
                0.45,
                { mu, 0, 50 * mu, 0.5, 0, 1, 0, 0, 0, 1, 0 },
                1.15,
                0.7 },
        Tissue{ "guccione", law_of<physics::Guccione>, 0.49, { 0.25 * mu, 0, 8, 2, 4, 1, 0, 0 }, 1.01 }),
    [](const auto& of) { return of.param.name; });

namespace
{

std::vector<Tissue> examples()
{
  std::vector<Tissue> tissues;
  for (const Law law : physics::every_law)
    tissues.push_back({ physics::description_of(law).name, law, 0.49, physics::example_of(law), 1.02 });
  return tissues;
}

}  // namespace

INSTANTIATE_TEST_SUITE_P(Examples, TimeStepBound, testing::ValuesIn(examples()),
                         [](const auto& of) { return of.param.name; });
