#include "frontalis/physics/exponential.hpp"
#include "frontalis/physics/guccione.hpp"
#include "frontalis/physics/holzapfel.hpp"
#include "frontalis/physics/mooney_rivlin.hpp"
#include "frontalis/physics/neo_hookean.hpp"
#include "frontalis/physics/ogden.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <string>

using namespace frontalis::physics;

namespace
{

using Matrix = Matrix3<double>;

Kinematics<double> kinematics_of(const Matrix& F)
{
  double mode[3][8] = {};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      mode[i][gradient_mode(j)] = F.a[i][j] - (i == j);
  const double one[3] = { 1, 1, 1 };
  return kinematics(mode[0], mode[1], mode[2], one);
}

const Vec3<double> families[2] = { { 0.8, 0.6, 0 }, { 0.8, -0.6, 0 } };

struct LawCase
{
  std::string name;
  double shear_modulus;  // at rest
  std::function<double(const Kinematics<double>&)> energy;
  std::function<void(const Kinematics<double>&, Matrix&)> add_stress;
};

template <class Material>
LawCase isotropic(const std::string& name, double shear_modulus, const Material& material)
{
  return { name, shear_modulus, [material](const Kinematics<double>& k) { return energy(material, k); },
           [material](const Kinematics<double>& k, Matrix& P) { add_stress(material, k, P); } };
}

std::vector<LawCase> cases()
{
  const HolzapfelGasserOgden<double> skin{ 2.0, 3.0, 0.8, 0.1 };
  const Guccione<double> heart{ 2.0, 8.0, 1.5, 4.0 };
  return { isotropic("MooneyRivlin", 2 * (1.2 + 0.7), MooneyRivlin<double>{ 1.2, 0.7 }),
           isotropic("Fung", 1.5, FungExponential<double>{ 1.5, 2.0 }),
           isotropic("Ogden", 0.5 * (1.3 * 2.5 + -0.4 * -2.0), Ogden<double>{ { 1.3, -0.4 }, { 2.5, -2.0 } }),
           { "Holzapfel", 2.0, [skin](const Kinematics<double>& k) { return energy(skin, k, families); },
             [skin](const Kinematics<double>& k, Matrix& P) { add_stress(skin, k, families, P); } },
           // shear of yz with the fibre along (0.8, 0.6, 0): Efs^2 + Efn^2 = (0.6 / 2)^2 of its square
           { "Guccione", 2.0 * ((4.0 - 1.5) * 2 * 0.09 + 1.5 / 2),
             [heart](const Kinematics<double>& k) { return energy(heart, k, families[0]); },
             [heart](const Kinematics<double>& k, Matrix& P) { add_stress(heart, k, families[0], P); } } };
}

class IsochoricLaw : public testing::TestWithParam<LawCase>
{
};

Matrix identity() { return { { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } }; }

}  // namespace

TEST_P(IsochoricLaw, StressIsTheGradientOfTheEnergyAlsoWhereCrushedAndInverted)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> distribution(-0.35, 0.35);
  for (int trial = 0; trial < 200; ++trial)
  {
    Matrix F = identity();
    F.a[2][2] = trial % 3 == 0 ? -0.6 : trial % 3 == 1 ? 0.1 : 1;
    for (auto& row : F.a)
      for (auto& x : row)
        x += distribution(random);
    Matrix P{};
    GetParam().add_stress(kinematics_of(F), P);
    const double step = 1e-6;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
      {
        Matrix more = F, less = F;
        more.a[i][j] += step;
        less.a[i][j] -= step;
        const double slope =
            (GetParam().energy(kinematics_of(more)) - GetParam().energy(kinematics_of(less))) / (2 * step);
        ASSERT_NEAR(P.a[i][j], slope, 2e-5 * (1 + std::abs(slope))) << trial << " " << i << j;
      }
  }
}

TEST_P(IsochoricLaw, AtRestItIsFreeOfDeviatoricStressAndHasItsShearModulus)
{
  EXPECT_NEAR(GetParam().energy(kinematics_of(identity())), 0, 1e-12);
  Matrix P{};
  GetParam().add_stress(kinematics_of(identity()), P);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      EXPECT_NEAR(P.a[i][j], 0, 1e-9);
  // shear in the plane normal to all fibres' dispersion-free direction: fibres stay slack in xz for small shear
  Matrix F = identity();
  F.a[2][1] = 1e-6;
  P = {};
  GetParam().add_stress(kinematics_of(F), P);
  EXPECT_NEAR(P.a[2][1] / 1e-6, GetParam().shear_modulus, 1e-4 * GetParam().shear_modulus);
}

TEST_P(IsochoricLaw, IsObjective)
{
  Matrix F = identity();
  F.a[0][0] = 1.3;
  F.a[0][1] = 0.2;
  F.a[2][2] = 0.8;
  const double a = 1.1, c = std::cos(a), s = std::sin(a);
  const Matrix R{ { { c, -s, 0 }, { s, c, 0 }, { 0, 0, 1 } } };
  Matrix RF{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k)
        RF.a[i][j] += R.a[i][k] * F.a[k][j];
  EXPECT_NEAR(GetParam().energy(kinematics_of(RF)), GetParam().energy(kinematics_of(F)), 1e-10);
}

TEST_P(IsochoricLaw, IsFiniteWhenCrushedFlatAndPushedOpenWhenInverted)
{
  for (const double z : { 0.1, 1e-3, 0.0, -0.5, -2.0 })
  {
    Matrix F = identity();
    F.a[2][2] = z;
    Matrix P{};
    GetParam().add_stress(kinematics_of(F), P);
    for (const auto& row : P.a)
      for (const double x : row)
        EXPECT_TRUE(std::isfinite(x)) << z;
    EXPECT_LT(P.a[2][2], 0) << z;
  }
}

INSTANTIATE_TEST_SUITE_P(Laws, IsochoricLaw, testing::ValuesIn(cases()),
                         [](const auto& parameter) { return parameter.param.name; });

TEST(Ogden, WithExponentTwoIsNeoHookean)
{
  Matrix F = identity();
  F.a[0][0] = 1.4;
  F.a[1][0] = 0.3;
  F.a[2][2] = 0.7;
  const auto k = kinematics_of(F);
  Matrix P{};
  add_stress(Ogden<double>{ { 1.0, 0.0 }, { 2.0, 1.0 } }, k, P);
  const auto expected = stress(NeoHookean<double>{ 1.0, 0.0 }, k);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      EXPECT_NEAR(P.a[i][j], expected.on_gradient * F.a[i][j] + expected.on_cofactor * k.cofactor.a[i][j], 1e-9);
}

TEST(Exponential, IsContinuedAlongItsTangent)
{
  const double step = 1e-6;
  for (const double x : { -3.0, 5.0, exponent_limit, 100.0 })
    EXPECT_NEAR((bounded_exponential(x + step) - bounded_exponential(x - step)) / (2 * step),
                bounded_exponential_slope(x), 1e-5 * bounded_exponential_slope(x));
  EXPECT_TRUE(std::isfinite(bounded_exponential(1e6f)));
}
