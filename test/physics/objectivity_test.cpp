// Stress must rotate with the body: P(Q F) = Q P(F) for laws, muscle fibres and relaxed stress. A rotation of the
// material at rest and of its fibres must only change the axes: P(F Q) with directions Q^T a equals P(F) Q.

#include "frontalis/physics/muscle_fibre.hpp"
#include "frontalis/physics/viscosity.hpp"
#include "physics/every_law.hpp"

#include <gtest/gtest.h>

#include <functional>

using namespace frontalis;
using namespace frontalis::physics;
using namespace frontalis::physics::test;

namespace
{

void for_random_motions(const std::function<void(const Matrix& F, const Matrix& Q)>& check)
{
  std::mt19937 random(3);
  for (int trial = 0; trial < 200; ++trial)
  {
    const Matrix F = random_gradient(random, trial);
    check(F, random_rotation(random));
  }
}

Matrix fibre_stress_at(const Matrix& F, const Vec3<double>& a, double with_length)
{
  const Vec3<double> along = F * a;
  const double S = fibre_stress(dot(along, along), 0.3e6, 0.7, with_length, 1.0);
  return { { { S * along.x * a.x, S * along.x * a.y, S * along.x * a.z },
             { S * along.y * a.x, S * along.y * a.y, S * along.y * a.z },
             { S * along.z * a.x, S * along.z * a.y, S * along.z * a.z } } };
}

}  // namespace

class ObjectiveLaw : public test::LawTest
{
};

TEST_P(ObjectiveLaw, EnergyAndStressTurnWithTheBody)
{
  for_random_motions(
      [&](const Matrix& F, const Matrix& Q)
      {
        ASSERT_NEAR(energy_at(Q * F), energy_at(F), 1e-9 * (modulus + energy_at(F)));
        const Matrix P = stress_at(F);
        ASSERT_LT(test::distance(stress_at(Q * F), Q * P), 1e-9 * (modulus + largest(P)));
      });
}

TEST_P(ObjectiveLaw, HasNoDirectionsButThoseOfItsFibres)
{
  for_random_motions(
      [&](const Matrix& F, const Matrix& Q)
      {
        const Matrix P = stress_at(F);
        turn_directions(transposed(Q));
        ASSERT_LT(test::distance(stress_at(F * Q), P * Q), 1e-9 * (modulus + largest(P)));
        turn_directions(Q);
      });
}

TEST_P(ObjectiveLaw, RelaxedStressTurnsWithTheBody)
{
  for_random_motions(
      [&](const Matrix& F, const Matrix& Q)
      {
        Matrix P[2];
        for (const bool turned : { false, true })
        {
          Symmetric3<double> H{};
          // The body is rotated while it relaxes.
          for (const Matrix& now : { F, turned ? Q * F : F })
            relax(0.4, 0.6, second_piola(kinematics_of(now), stress_at(now)), H);
          const Matrix last = turned ? Q * F : F;
          P[turned] = stress_at(last);
          take_relaxed(kinematics_of(last), H, P[turned]);
        }
        ASSERT_LT(test::distance(P[1], Q * P[0]), 1e-8 * (modulus + largest(stress_at(F))));
      });
}

EVERY_LAW_SUITE(ObjectiveLaw);

TEST(MuscleFibre, StressTurnsWithTheBodyAndWithItsDirection)
{
  const Vec3<double> a{ 0.48, 0.6, 0.64 };
  for (const double with_length : { 0.0, 1.0 })
    for_random_motions(
        [&](const Matrix& F, const Matrix& Q)
        {
          const Matrix P = fibre_stress_at(F, a, with_length);
          const double scale = 0.3e6 + largest(P);
          ASSERT_LT(test::distance(fibre_stress_at(Q * F, a, with_length), Q * P), 1e-9 * scale);
          ASSERT_LT(test::distance(fibre_stress_at(F * Q, transposed(Q) * a, with_length), P * Q), 1e-9 * scale);
        });
}
