// Properties of every law of the table, and closed forms of some.

#include "frontalis/physics/materials/lookup.hpp"
#include "physics/every_law.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

using namespace frontalis;
using namespace frontalis::physics;
using namespace frontalis::physics::test;

using EveryLaw = test::LawTest;

TEST_P(EveryLaw, StressIsTheGradientOfTheEnergyAlsoWhereCrushedAndInverted)
{
  std::mt19937 random(1);
  for (int trial = 0; trial < 200; ++trial)
  {
    const Matrix F = random_gradient(random, trial);
    const Matrix P = stress_at(F);
    const double step = 1e-6;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
      {
        Matrix more = F, less = F;
        more.a[i][j] += step;
        less.a[i][j] -= step;
        const double slope = (energy_at(more) - energy_at(less)) / (2 * step);
        ASSERT_NEAR(P.a[i][j], slope, 2e-5 * (modulus + std::abs(slope))) << trial << " " << i << j;
      }
  }
}

TEST_P(EveryLaw, AtRestItIsFreeOfStressAndHasItsShearModulus)
{
  EXPECT_NEAR(energy_at(identity()), 0, 1e-12 * modulus);
  EXPECT_LT(largest(stress_at(identity())), 1e-9 * modulus);
  Matrix F = identity();
  F.a[2][1] = 1e-6;
  // The modulus in the description of a law with fibres may hold for another direction.
  const double found = stress_at(F).a[2][1] / 1e-6;
  if (description_of(GetParam()).directions == 0)
    EXPECT_NEAR(found, modulus, 1e-4 * modulus);
  else
    EXPECT_GT(found, 0);
}

// test/solver/voxel_bound_test.cpp tests the bound in deformed voxels.
TEST_P(EveryLaw, TheBoundOfItsTangentStiffnessHoldsAtRestAndIsBlindToRotations)
{
  const double at_rest = tangent_bound_at(identity());
  EXPECT_LE(modulus, at_rest * (1 + 1e-12));
  std::mt19937 random(2);
  for (int trial = 0; trial < 200; ++trial)
    EXPECT_NEAR(tangent_bound_at(random_rotation(random)), at_rest, 1e-9 * at_rest);
}

TEST_P(EveryLaw, IsFiniteWhenCrushedFlatAndPushedOpenWhenInverted)
{
  for (const double z : { 0.1, 1e-3, 0.0, -0.5, -2.0 })
  {
    const Matrix P = stress_at(diagonal(1, 1, z));
    for (const auto& row : P.a)
      for (const double x : row)
        EXPECT_TRUE(std::isfinite(x)) << z;
    EXPECT_LT(P.a[2][2], 0) << z;
  }
}

TEST_P(EveryLaw, ItsDescriptionIsWhole)
{
  const MaterialDescription& description = description_of(GetParam());
  EXPECT_EQ(law_named(description.name), GetParam()) << "two laws have one name";
  EXPECT_GE(description.count(), 1);
  EXPECT_TRUE(description.directions >= 0 && description.directions <= 2);
  std::set<std::string> keys{ "law", "density", "poisson", "viscosity", "fibre", "families", "along", "tension" };
  for (const Parameter& parameter : description)
  {
    EXPECT_TRUE(keys.insert(parameter.key).second) << parameter.key << " means something else";
    const Range& range = parameter.range;
    EXPECT_TRUE(parameter.example >= range.lower && parameter.example <= range.upper) << parameter.key;
    EXPECT_NE(parameter.meaning, nullptr);
  }
  EXPECT_GT(modulus, 0);
}

EVERY_LAW_SUITE(EveryLaw);

TEST(Holzapfel, FibresAreSlackInShearAcrossTheirPlane)
{
  Matrix F = identity(), P{};
  F.a[2][1] = 1e-6;
  const Vec3<double> families[2] = { { 0.8, 0.6, 0 }, { 0.8, -0.6, 0 } };
  add_stress(HolzapfelGasserOgden<double>{ 2.0, 3.0, 0.8, 0.1 }, kinematics_of(F), families, P);
  EXPECT_NEAR(P.a[2][1] / 1e-6, 2.0, 1e-4);
}

TEST(Guccione, ShearModulusAcrossAFibreAtAnAngle)
{
  // With shear in yz and the fibre along (0.8, 0.6, 0), Efs^2 + Efn^2 is (0.6 / 2)^2 times the squared shear.
  Matrix F = identity(), P{};
  F.a[2][1] = 1e-6;
  const Vec3<double> fibre[1] = { { 0.8, 0.6, 0 } };
  add_stress(Guccione<double>{ 2.0, 8.0, 1.5, 4.0 }, kinematics_of(F), fibre, P);
  const double expected = 2.0 * ((4.0 - 1.5) * 2 * 0.09 + 1.5 / 2);
  EXPECT_NEAR(P.a[2][1] / 1e-6, expected, 1e-4 * expected);
}

TEST(Ogden, WithExponentTwoIsNeoHookean)
{
  Matrix F = identity(), P{}, expected{};
  F.a[0][0] = 1.4;
  F.a[1][0] = 0.3;
  F.a[2][2] = 0.7;
  add_stress(Ogden<double>{ 1.0, 2.0, 0.0, 1.0 }, kinematics_of(F), P);
  add_stress(NeoHookean<double>{ 1.0, 0.0, 0.0 }, kinematics_of(F), expected);
  EXPECT_LT(test::distance(P, expected), 1e-9);
}

TEST(Exponential, IsContinuedAlongItsTangent)
{
  const double step = 1e-6;
  for (const double x : { -3.0, 5.0, exponent_limit, 100.0 })
    EXPECT_NEAR((bounded_exponential(x + step) - bounded_exponential(x - step)) / (2 * step),
                bounded_exponential_slope(x), 1e-5 * bounded_exponential_slope(x));
  EXPECT_TRUE(std::isfinite(bounded_exponential(1e6f)));
}
