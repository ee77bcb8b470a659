// sheets, and laminates made of them

#include "frontalis/physics/laminate.hpp"
#include "frontalis/physics/materials/neo_hookean.hpp"
#include "physics/deformation.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace frontalis::physics;
using namespace frontalis::physics::test;

namespace
{

Vec3<double> random_normal(std::mt19937& random) { return random_rotation(random) * Vec3<double>{ 0, 0, 1 }; }

double energy_at(const Sheet<double>& sheet, const Matrix& F) { return energy(sheet, kinematics_of(F)); }

// Energy of linear elasticity.
double linear_energy(double mu, double poisson, const Eigen::Matrix3d& gradient)
{
  const Eigen::Matrix3d strain = 0.5 * (gradient + gradient.transpose());
  const double lambda = 2 * mu * poisson / (1 - 2 * poisson);
  return mu * strain.squaredNorm() + 0.5 * lambda * strain.trace() * strain.trace();
}

}  // namespace

TEST(Sheet, StressIsTheGradientOfTheEnergyAndItsBoundHolds)
{
  std::mt19937 random(3);
  std::normal_distribution<double> value;
  double closest = 0;
  for (int trial = 0; trial < 300; ++trial)
  {
    const Sheet<double> sheet{ 2, 5, random_normal(random) };
    const Matrix F = random_gradient(random, trial);
    Matrix P{}, change;
    add_stress(sheet, kinematics_of(F), P);
    double length = 0, slope = 0;
    for (auto& row : change.a)
      for (double& x : row)
      {
        x = value(random);
        length += x * x;
      }
    Matrix more = F, less = F;
    const double step = 1e-5;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
      {
        slope += P.a[i][j] * change.a[i][j] / std::sqrt(length);
        more.a[i][j] += step * change.a[i][j] / std::sqrt(length);
        less.a[i][j] -= step * change.a[i][j] / std::sqrt(length);
      }
    const double up = energy_at(sheet, more), down = energy_at(sheet, less);
    EXPECT_NEAR(slope, (up - down) / (2 * step), 1e-5 * (1 + std::abs(slope))) << trial;
    const double bend = (up + down - 2 * energy_at(sheet, F)) / (step * step);
    const double bound = 2 * tangent_stiffness(sheet, kinematics_of(F));
    EXPECT_LT(bend, bound + 1e-3) << trial;
    closest = std::max(closest, bend / bound);
  }
  EXPECT_GT(closest, 0.2) << "the bound is far too careful";
}

TEST(Sheet, FeelsNeitherRotationNorShearAcrossIt)
{
  std::mt19937 random(4);
  const Sheet<double> sheet{ 2, 5, { 0, 0, 1 } };
  Matrix F = diagonal(1.2, 0.9, 0.5);
  const double before = energy_at(sheet, F);
  EXPECT_NEAR(before, 0.5 * 2 * 0.3 * 0.3 + 0.5 * 5 * 0.08 * 0.08, 1e-9);
  F.a[0][2] = 0.4;
  F.a[2][2] = 1.3;
  EXPECT_NEAR(energy_at(sheet, F), before, 1e-12);
  EXPECT_NEAR(energy_at(sheet, random_rotation(random) * F), before, 1e-12);
}

// The energy of two layers is the least over all deformations with one mean that fit at their faces: the gradients of
// the layers differ by a dyad a (x) n.
TEST(Laminate, HasTheEnergyOfItsLayersForSmallStrain)
{
  std::mt19937 random(5);
  std::normal_distribution<double> value;
  for (const double poisson : { 0.3, 0.49 })
    for (int trial = 0; trial < 20; ++trial)
    {
      const double share = 0.3, mu[2] = { 1, 40 };
      const Vec3<double> n = random_normal(random);
      const Eigen::Vector3d normal(n.x, n.y, n.z);
      Eigen::Matrix3d H;
      for (int i = 0; i < 9; ++i)
        H(i / 3, i % 3) = 1e-4 * value(random);
      const auto of_layers = [&](const Eigen::Vector3d& a)
      {
        return (1 - share) * linear_energy(mu[0], poisson, H + share * a * normal.transpose()) +
               share * linear_energy(mu[1], poisson, H - (1 - share) * a * normal.transpose());
      };
      // the energy is quadratic in a, so that differences give its minimum exactly
      Eigen::Matrix3d stiffness;
      Eigen::Vector3d force;
      const double least = of_layers(Eigen::Vector3d::Zero());
      const auto unit = [](int i) { return Eigen::Vector3d(1e-4 * Eigen::Vector3d::Unit(i)); };
      for (int i = 0; i < 3; ++i)
      {
        force[i] = 0.5 * (of_layers(unit(i)) - of_layers(-unit(i)));
        for (int j = 0; j < 3; ++j)
          stiffness(i, j) = of_layers(unit(i) + unit(j)) - of_layers(unit(i)) - of_layers(unit(j)) + least;
      }
      const double expected = least - 0.5 * force.dot(stiffness.ldlt().solve(force));

      const double arithmetic = (1 - share) * mu[0] + share * mu[1];
      const double harmonic = 1 / ((1 - share) / mu[0] + share / mu[1]);
      const double difference = arithmetic - harmonic;
      const Sheet<double> sheet{ difference, difference * (1 + poisson) / (1 - poisson), n };
      Matrix F = identity();
      for (int i = 0; i < 9; ++i)
        F.a[i / 3][i % 3] += H(i / 3, i % 3);
      const double found = linear_energy(harmonic, poisson, H) + energy_at(sheet, F);
      EXPECT_NEAR(found, expected, 2e-3 * expected) << poisson << " " << trial;
    }
}
