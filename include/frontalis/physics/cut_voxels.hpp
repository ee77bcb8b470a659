#pragma once

#include "frontalis/physics/symmetric_eigen.hpp"
#include "frontalis/physics/voxel_element.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace frontalis
{
namespace physics
{

// A cut voxel is only partly filled with tissue. Its stress is computed at the centroid of the tissue, and not at the
// centre of the voxel as in a whole voxel. At the centroid the gradient of trilinear displacements also depends on the
// hourglass modes. Let q be the transformed displacements, and T the linear map that replaces their mean gradient by
// the gradient at the centroid. The energy of a cut voxel is that of a whole voxel at T q, so that its forces are T^T
// times the forces at T q. This holds for every material law, and energy and momentum are conserved.

/// The centroid of the tissue in a voxel, from -1 to 1 along each axis; 0 in a whole voxel.
template <class T>
struct TissueCentre
{
  T x, y, z;
};

/// Applies T to the transformed displacements of one component: replaces the mean gradient by that at the centroid.
template <class T>
FRONTALIS_LAW void to_tissue_centre(const TissueCentre<T>& c, T (&mode)[8])
{
  mode[1] = mode[1] + c.y * mode[3] + c.z * mode[5] + (c.y * c.z) * mode[7];
  mode[2] = mode[2] + c.x * mode[3] + c.z * mode[6] + (c.x * c.z) * mode[7];
  mode[4] = mode[4] + c.x * mode[5] + c.y * mode[6] + (c.x * c.y) * mode[7];
}

/// Applies T^T to the forces of one component: forces on the gradient at the centroid act on the hourglass modes too.
template <class T>
FRONTALIS_LAW void from_tissue_centre(const TissueCentre<T>& c, T (&force)[8])
{
  force[3] = force[3] + c.y * force[1] + c.x * force[2];
  force[5] = force[5] + c.z * force[1] + c.x * force[4];
  force[6] = force[6] + c.z * force[2] + c.y * force[4];
  force[7] = force[7] + (c.y * c.z) * force[1] + (c.x * c.z) * force[2] + (c.x * c.y) * force[4];
}

/// Factors r_b of the bound of the time step at the corners b of a cut voxel. Where a whole voxel with the same tissue
/// contributes its stiffness bound k to each corner (physics/time_step.hpp), a cut voxel contributes r_b k.
/// `hourglass`: largest eigenvalue of hourglass control divided by that of the stress, both at rest.
///
/// With G the 8 x 3 matrix of shape function gradients in units of 1/h, a whole voxel has G^T G = 1/2, so that k bounds
/// the quadratic form Q of its stress by Q(Z) <= 2 k |Z|^2 for every gradient Z, deformed or not. For diagonal weights
/// w for which the largest eigenvalue of G^T w^-1 G is at most 1, displacements x have |x^T G|^2 <= sum of w_b |x_b|^2,
/// so that 2 w_b k + `hourglass` k is a bound at corner b. Weights in proportion to |G_b| are small at corners far from
/// the tissue, which have little mass. No weight is below 1/2, the value of a whole voxel, because k may include other
/// stiffness, which acts at all corners alike. Where this lower limit applies, the other weights are multiplied by the
/// largest eigenvalue, which stays at most 1.
inline std::array<float, 8> corner_stiffness(const TissueCentre<double>& centre, double hourglass)
{
  double gradient[8][3], length[8];
  for (int b = 0; b < 8; ++b)
  {
    const double sign[3] = { b & 1 ? 1.0 : -1.0, b & 2 ? 1.0 : -1.0, b & 4 ? 1.0 : -1.0 };
    const double at[3] = { 1 + sign[0] * centre.x, 1 + sign[1] * centre.y, 1 + sign[2] * centre.z };
    for (int i = 0; i < 3; ++i)
      gradient[b][i] = 0.25 * sign[i] * at[(i + 1) % 3] * at[(i + 2) % 3];
    length[b] =
        std::sqrt(gradient[b][0] * gradient[b][0] + gradient[b][1] * gradient[b][1] + gradient[b][2] * gradient[b][2]);
  }
  constexpr double least = 0.5;
  double per_length = 16;
  const auto weight = [&](int b) { return std::max(least, per_length * length[b]); };
  for (int repetition = 0; repetition < 5; ++repetition)
  {
    Matrix3<double> sum{};
    for (int b = 0; b < 8; ++b)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          sum.a[i][j] += gradient[b][i] * gradient[b][j] / weight(b);
    const auto eigen = symmetric_eigen(sum);
    per_length *= std::min(1.0, std::max({ eigen.value[0], eigen.value[1], eigen.value[2] }) * (1 + 1e-9));
  }
  std::array<float, 8> factors{};
  for (int b = 0; b < 8; ++b)
    factors[static_cast<std::size_t>(b)] = static_cast<float>((2 * weight(b) + hourglass) * (1 + 1e-6));
  return factors;
}

}  // namespace physics
}  // namespace frontalis
