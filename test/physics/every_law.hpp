#pragma once

#include "frontalis/physics/materials/lookup.hpp"
#include "physics/deformation.hpp"

#include <gtest/gtest.h>

#include <string>

namespace frontalis
{
namespace physics
{
namespace test
{

/// The isochoric part of the example of a law, in double precision.
class LawTest : public testing::TestWithParam<Law>
{
protected:
  LawTest() { numbers_[bulk_modulus_slot] = 0; }

  double energy_at(const Matrix& F) const
  {
    double sum = 0;
    visit([&](const auto& solid, const auto&... along) { sum = energy(solid, kinematics_of(F), along...); });
    return sum;
  }
  Matrix stress_at(const Matrix& F) const
  {
    Matrix P{};
    visit([&](const auto& solid, const auto&... along) { add_stress(solid, kinematics_of(F), along..., P); });
    return P;
  }
  double tangent_bound_at(const Matrix& F) const
  {
    double bound = 0;
    visit([&](const auto& solid, const auto&... along)
          { bound = tangent_stiffness(solid, kinematics_of(F), along...); });
    return bound;
  }
  /// Rotates the law's fibre directions, if it has any.
  void turn_directions(const Matrix& Q)
  {
    for (int d = 0; d < description_of(GetParam()).directions; ++d)
    {
      double* const a = numbers_.data() + first_direction + 3 * d;
      const Vec3<double> turned = Q * Vec3<double>{ a[0], a[1], a[2] };
      a[0] = turned.x, a[1] = turned.y, a[2] = turned.z;
    }
  }

private:
  template <class Visit>
  void visit(const Visit& visit) const
  {
    visit_table(GetParam(), numbers_.data(), visit);
  }

  MaterialNumbers numbers_ = example_of(GetParam());

protected:
  const double modulus = shear_modulus_of(GetParam(), numbers_);
};

#define EVERY_LAW_SUITE(suite)                                         \
  INSTANTIATE_TEST_SUITE_P(Table, suite, testing::ValuesIn(every_law), \
                           [](const auto& law) { return std::string(description_of(law.param).name); })

}  // namespace test
}  // namespace physics
}  // namespace frontalis
