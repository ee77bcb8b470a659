#include "block_model.hpp"

#include "frontalis/solver/solver.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

using namespace frontalis;
using Vectors = std::vector<std::array<double, 3>>;

namespace
{

using Matrix = std::array<std::array<double, 3>, 3>;

Matrix product(const Matrix& a, const Matrix& b)
{
  Matrix c{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k)
        c[i][j] += a[i][k] * b[k][j];
  return c;
}

// from a random unit quaternion
Matrix random_rotation(std::mt19937& random)
{
  std::normal_distribution<double> normal;
  double q[4], length = 0;
  for (double& x : q)
  {
    x = normal(random);
    length += x * x;
  }
  for (double& x : q)
    x /= std::sqrt(length);
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  return { { { { 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y) } },
             { { 2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x) } },
             { { 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y) } } } };
}

// stretches up to `most` and down to its inverse, volume kept to within 2 % in three of four
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
  Matrix diagonal{};
  for (int i = 0; i < 3; ++i)
    diagonal[i][i] = scale * stretch[i];
  return product(random_rotation(random), product(diagonal, random_rotation(random)));
}

// largest eigenvalue of a symmetric matrix, by power iteration on one that is shifted to be positive
double largest_eigenvalue(const std::vector<std::vector<double>>& K)
{
  double shift = 0;
  for (const auto& row : K)
    for (const double x : row)
      shift += x * x;
  shift = 0.3 * std::sqrt(shift);
  std::vector<double> mode(K.size()), next(K.size());
  for (std::size_t i = 0; i < mode.size(); ++i)
    mode[i] = std::sin(1.0 + 3.0 * static_cast<double>(i));
  double value = 0;
  for (int iteration = 0; iteration < 300; ++iteration)
  {
    double length = 0;
    for (std::size_t i = 0; i < K.size(); ++i)
    {
      next[i] = shift * mode[i];
      for (std::size_t j = 0; j < K.size(); ++j)
        next[i] += 0.5 * (K[i][j] + K[j][i]) * mode[j];
      length += next[i] * next[i];
    }
    value = std::sqrt(length);
    for (std::size_t i = 0; i < K.size(); ++i)
      mode[i] = next[i] / value;
  }
  return value - shift;
}

// square of the true highest frequency of a lone voxel at a deformation, over the bound's
double true_over_bound(const Model& model, const Matrix& F)
{
  const auto solver = make_solver(std::make_shared<const Model>(model), { Backend::reference, 1, 0 });
  Vectors u(8), moved, plus, minus;
  for (std::size_t n = 0; n < 8; ++n)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        u[n][i] += (F[i][j] - (i == j ? 1 : 0)) * test::rest(model, n)[j];
  solver->set_displacements(u);
  const double critical = solver->monitor().critical_time_step;
  std::vector<std::vector<double>> K(24, std::vector<double>(24));
  for (std::size_t a = 0; a < 24; ++a)
  {
    const double step = 1e-8;
    for (const double sign : { 1.0, -1.0 })
    {
      moved = u;
      moved[a / 3][a % 3] += sign * step;
      solver->set_displacements(moved);
      solver->internal_forces(sign > 0 ? plus : minus);
    }
    for (std::size_t b = 0; b < 24; ++b)
      K[a][b] = (plus[b / 3][b % 3] - minus[b / 3][b % 3]) / (2 * step);
  }
  const double mass = model.materials[0].density * 1e-9 / 8;
  return largest_eigenvalue(K) / mass * critical * critical / 4;
}

struct Tissue
{
  const char* name;
  Law law;
  double poisson;
  std::array<double, 11> own;  // in place of parameters that are not 0 here
  double allowed;
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
  EXPECT_GT(worst, 0.9) << "far too careful";
}

INSTANTIATE_TEST_SUITE_P(
    Laws, TimeStepBound,
    testing::Values(Tissue{ "neo_hookean", Law::neo_hookean, 0.49, {}, 1.01 },
                    Tissue{ "neo_hookean_compressible", Law::neo_hookean, 0.3, {}, 1.1 },
                    Tissue{ "neo_hookean_nearly_incompressible", Law::neo_hookean, 0.4999, {}, 1.01 },
                    Tissue{ "mooney_rivlin", Law::mooney_rivlin, 0.49, { 0.25 * mu, 0, 0.25 * mu }, 1.01 },
                    Tissue{ "ogden", Law::ogden, 0.49, { 0.5 * mu, 0, 2, -0.25 * mu, -4 }, 1.01 },
                    Tissue{ "fung", Law::fung, 0.49, { 0, 0, 4 }, 1.02 },
                    Tissue{ "holzapfel", Law::holzapfel, 0.49, { mu, 0, mu, 5, 0, 1, 0, 0, 0, 1, 0 }, 1.02 },
                    Tissue{ "guccione", Law::guccione, 0.49, { 0.25 * mu, 0, 8, 2, 4, 1, 0, 0 }, 1.01 }),
    [](const auto& of) { return of.param.name; });
