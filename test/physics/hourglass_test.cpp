#include "frontalis/physics/assumed_strain.hpp"
#include "frontalis/physics/hourglass.hpp"
#include "frontalis/physics/time_step.hpp"
#include "frontalis/physics/trilinear.hpp"
#include "frontalis/physics/voxel_element.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace frontalis::physics;

namespace
{

double corner(int b, int axis) { return (b >> axis) & 1; }

}  // namespace

TEST(VoxelElement, LinearFieldsExciteNoHourglassMode)
{
  double a[8];
  for (int b = 0; b < 8; ++b)
    a[b] = 0.3 + 0.7 * corner(b, 0) - 1.1 * corner(b, 1) + 0.2 * corner(b, 2);
  walsh_hadamard(a);
  for (int m = 0; m < 8; ++m)
    EXPECT_NEAR(is_hourglass_mode(m) ? a[m] : 0, 0, 1e-14) << m;
  EXPECT_NEAR(a[gradient_mode(0)], 4 * 0.7, 1e-14);
  EXPECT_NEAR(a[gradient_mode(1)], 4 * -1.1, 1e-14);
  EXPECT_NEAR(a[gradient_mode(2)], 4 * 0.2, 1e-14);
}

TEST(VoxelElement, TransposeIsTheTranspose)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> value(-1, 1);
  double x[8], y[8], forward[8], backward[8];
  for (int i = 0; i < 8; ++i)
  {
    forward[i] = x[i] = value(random);
    backward[i] = y[i] = value(random);
  }
  walsh_hadamard(forward);
  walsh_hadamard_transposed(backward);
  double left = 0, right = 0;
  for (int i = 0; i < 8; ++i)
  {
    left += forward[i] * y[i];
    right += x[i] * backward[i];
  }
  EXPECT_NEAR(left, right, 1e-13);
}

TEST(Hourglass, BendingModeHasTheEnergyOfPureBending)
{
  // The energy of u_x = c xi eta on a cube of edge h is the integral of 1/2 E (2c/h eta)^2.
  const double h = 2e-3, young = 1e5, c = 1e-5;
  double mode[8];
  for (int b = 0; b < 8; ++b)
    mode[b] = c * (2 * corner(b, 0) - 1) * (2 * corner(b, 1) - 1);
  walsh_hadamard(mode);
  double energy = 0;
  for (int m = 0; m < 8; ++m)
    if (is_hourglass_mode(m))
      energy += 0.5 * hourglass_stiffness(young, h * h * h, h) * mode[m] * mode[m];
  EXPECT_NEAR(energy, 0.5 * young * 4 * c * c / (h * h) * h * h * h / 3, 1e-18);
}

TEST(AssumedStrain, ABarBendsWithYoungsModulusAndAPlateIsStifferAlongShortEdges)
{
  const double young = 3e4, nu = 0.45, volume = 2e-9;
  const auto k = assumed_strain(young / (2 * (1 + nu)), young / (3 * (1 - 2 * nu)), volume);
  const double weight[3] = { 1, 0.5, 1 };  // the second edge is twice as long as the others
  for (int axis = 0; axis < 3; ++axis)
  {
    const AxisBending<double> b = axis_bending(k, weight, axis);
    // The energy equals that of a strain with free lateral contraction.
    EXPECT_NEAR(b.own - b.coupled * b.coupled / b.own, young * volume, 1e-12 * young * volume);
    EXPECT_NEAR(b.coupled / b.own, axis == 1 ? nu / 4 : nu, 1e-12);
  }
}

TEST(TimeStep, LoneCubeNearIncompressibility)
{
  // The critical time step is 0.585 h/c at nu = 0.49.
  const double young = 34e3, nu = 0.49, h = 1e-3, density = 1000;
  const double mu = young / (2 * (1 + nu)), kappa = young / (3 * (1 - 2 * nu));
  const double wave = std::sqrt((kappa + 4 * mu / 3) / density);
  const double mass = density * h * h * h;
  const double critical = 2 / std::sqrt(8 * voxel_stiffness(mu, kappa, 0.0, h * h * h, h, h, h) / mass);
  EXPECT_NEAR(critical, 0.585 * h / wave, 0.005 * h / wave);
}

TEST(Trilinear, ReproducesAffineFieldsInsideAndOutside)
{
  for (const double x : { 0.2, -0.7, 1.9 })
  {
    double weight[8], sum = 0, value = 0;
    trilinear_weights(x, 0.4, 1.2, weight);
    for (int b = 0; b < 8; ++b)
    {
      sum += weight[b];
      value += weight[b] * (2 + 3 * corner(b, 0) - corner(b, 1) + 5 * corner(b, 2));
    }
    EXPECT_NEAR(sum, 1, 1e-14);
    EXPECT_NEAR(value, 2 + 3 * x - 0.4 + 6, 1e-13);
  }
}
