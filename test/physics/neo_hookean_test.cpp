#include "frontalis/physics/materials/neo_hookean.hpp"
#include "physics/deformation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace frontalis::physics;
using namespace frontalis::physics::test;

namespace
{

Matrix first_piola(const NeoHookean<double>& material, const Matrix& F)
{
  Matrix P{};
  add_stress(material, kinematics_of(F), P);
  return P;
}

// A material with nu = 0.49 and mu = 1.
const NeoHookean<double> material{ 1.0, 2.0 * 1.49 / (3.0 * 0.02), 0 };

void expect_gradient_of_energy(const NeoHookean<double>& of, const Matrix& F)
{
  const Matrix P = first_piola(of, F);
  const double step = 1e-6;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
    {
      Matrix more = F, less = F;
      more.a[i][j] += step;
      less.a[i][j] -= step;
      const double slope = (energy(of, kinematics_of(more)) - energy(of, kinematics_of(less))) / (2 * step);
      EXPECT_NEAR(P.a[i][j], slope, 1e-6 * (1 + std::abs(slope))) << i << j;
    }
}

}  // namespace

TEST(NeoHookean, StressIsTheGradientOfTheEnergyAlsoWhereCrushedAndInverted)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> distribution(-0.6, 0.6);
  for (int trial = 0; trial < 200; ++trial)
  {
    Matrix F = diagonal(1, 1, trial % 3 == 0 ? -0.7 : trial % 3 == 1 ? 0.1 : 1);
    for (auto& row : F.a)
      for (auto& x : row)
        x += distribution(random);
    expect_gradient_of_energy(material, F);
    expect_gradient_of_energy({ 1, 2, 2 }, F);
  }
  // Where g is continued, the invariant of a voxel that is crushed from all sides is less than at rest.
  for (const double edge : { 0.5, 0.2 })
    expect_gradient_of_energy({ 1, 0, 2 }, diagonal(edge, edge, edge));
}

// The rounding error of a float near 1 is 1 % of a strain of 1e-5, and the bulk modulus magnifies this error 50 times.
TEST(NeoHookean, FloatKeepsThePressureOfSmallStrains)
{
  const double gradient[3][3] = { { 1.1e-5, 0.4e-5, -0.3e-5 },
                                  { 0.2e-5, -0.7e-5, 0.5e-5 },
                                  { -0.6e-5, 0.1e-5, -0.3e-5 } };
  float mode[3][8] = {};
  double exact[3][8] = {};
  const float scale[3] = { 250, 250, 250 };
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
    {
      mode[i][gradient_mode(j)] = static_cast<float>(gradient[i][j] / 250);
      exact[i][gradient_mode(j)] = double(mode[i][gradient_mode(j)]);
    }
  const auto k = kinematics(mode[0], mode[1], mode[2], scale);
  const auto reference = kinematics(exact[0], exact[1], exact[2], scale);
  EXPECT_NEAR(double(k.dilatation), reference.dilatation, 1e-6 * 1e-5);
  EXPECT_NEAR(reference.dilatation, reference.J - 1, 1e-15);
}

TEST(NeoHookean, UniaxialTable)
{
  // Uniaxial stretch with free sides. Columns: stretch, P11/mu, lateral stretch, J.
  const double table[7][4] = { { 0.5, -3.480201, 1.405832, 0.988182 }, { 0.7, -1.333561, 1.191455, 0.993695 },
                               { 0.9, -0.332530, 1.053031, 0.997987 }, { 1.1, 0.271538, 0.954416, 1.002001 },
                               { 1.3, 0.701838, 0.879723, 1.006086 },  { 1.5, 1.043711, 0.820731, 1.010399 },
                               { 2.0, 1.718609, 0.715038, 1.022560 } };
  for (const auto& row : table)
  {
    // Find by bisection the lateral stretch at which the sides are free of stress.
    double low = 0.3, high = 2.5;
    for (int i = 0; i < 100; ++i)
    {
      const double middle = 0.5 * (low + high);
      (first_piola(material, diagonal(row[0], middle, middle)).a[1][1] < 0 ? low : high) = middle;
    }
    const Matrix F = diagonal(row[0], low, low);
    EXPECT_NEAR(low, row[2], 2e-6);
    EXPECT_NEAR(first_piola(material, F).a[0][0], row[1], 2e-5);
    EXPECT_NEAR(kinematics_of(F).J, row[3], 2e-6);
  }
}

TEST(NeoHookean, SimpleShear)
{
  const double shear = 0.4;
  Matrix F = diagonal(1, 1, 1);
  F.a[0][1] = shear;
  const Matrix P = first_piola(material, F);
  // The Cauchy stress is P F^T / J with J = 1.
  const auto cauchy = [&](int i, int j)
  { return P.a[i][0] * F.a[j][0] + P.a[i][1] * F.a[j][1] + P.a[i][2] * F.a[j][2]; };
  EXPECT_NEAR(cauchy(0, 1), shear, 1e-12);
  EXPECT_NEAR(cauchy(0, 0), 2.0 / 3 * shear * shear, 1e-12);
  EXPECT_NEAR(cauchy(1, 1), -shear * shear / 3, 1e-12);
  EXPECT_NEAR(cauchy(2, 2), -shear * shear / 3, 1e-12);
}

// In simple shear the isochoric first invariant is 3 + shear^2.
TEST(NeoHookean, StiffeningAddsTheCubeOfTheShear)
{
  NeoHookean<double> stiffening = material;
  stiffening.stiffening = 0.3;
  for (const double shear : { 0.1, 0.4, 2.0 })
  {
    Matrix F = diagonal(1, 1, 1);
    F.a[0][1] = shear;
    EXPECT_NEAR(first_piola(stiffening, F).a[0][1], shear + 0.3 * shear * shear * shear, 1e-12) << shear;
  }
}

TEST(NeoHookean, CrushedAndInvertedElementsArePushedOpen)
{
  for (const double z : { 0.2, 0.1, 0.0, -0.3, -1.0 })
  {
    const double push = first_piola(material, diagonal(1, 1, z)).a[2][2];
    EXPECT_TRUE(std::isfinite(push));
    EXPECT_LT(push, 0) << "at " << z;
  }
}
