#pragma once

#include "frontalis/physics/isochoric.hpp"
#include "frontalis/physics/voxel_element.hpp"
#include "solver/model_voxel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace frontalis
{

/// Deformation at the centre of a voxel's tissue. `u`: displacements of all nodes [m].
inline physics::Kinematics<double> deformation_at_centre(const Model& model, const VoxelProperties& properties,
                                                         std::size_t voxel, const std::vector<std::array<double, 3>>& u)
{
  const auto& h = model.spacing;
  const double scale[3] = { 0.25 / h[0], 0.25 / h[1], 0.25 / h[2] };
  double mode[3][8];
  for (int axis = 0; axis < 3; ++axis)
  {
    for (int b = 0; b < 8; ++b)
      mode[axis][b] = u[model.voxel_nodes[voxel][b]][axis];
    physics::walsh_hadamard(mode[axis]);
    physics::to_tissue_centre(properties.centre, mode[axis]);
  }
  return physics::kinematics(mode[0], mode[1], mode[2], scale);
}

/// Green-Lagrange strain (F^T F - 1) / 2 [-].
inline physics::Matrix3<double> green_lagrange_strain(const physics::Kinematics<double>& k)
{
  physics::Matrix3<double> E;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
    {
      E.a[i][j] = i == j ? -0.5 : 0;
      for (int l = 0; l < 3; ++l)
        E.a[i][j] += 0.5 * k.F.a[l][i] * k.F.a[l][j];
    }
  return E;
}

/// Cauchy stress P F^T / J of materials and fibres [Pa], without viscous stresses. The divisor J has a lower limit.
inline physics::Matrix3<double> cauchy_stress(const ModelVoxel& voxel, const physics::Kinematics<double>& k)
{
  physics::Matrix3<double> P = physics::elastic_stress(voxel, voxel.material(), k);
  physics::add_fibres(voxel, k, P);
  const double divisor = std::max(k.J, physics::continuation_jacobian) * voxel.properties.tissue_volume;
  physics::Matrix3<double> stress;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
    {
      stress.a[i][j] = 0;
      for (int l = 0; l < 3; ++l)
        stress.a[i][j] += P.a[i][l] * k.F.a[j][l] / divisor;
    }
  return stress;
}

/// Von Mises stress of a Cauchy stress, in its unit.
inline double von_mises(const physics::Matrix3<double>& stress)
{
  const auto& s = stress.a;
  const double a = s[0][0] - s[1][1], b = s[1][1] - s[2][2], c = s[2][2] - s[0][0];
  return std::sqrt(0.5 * (a * a + b * b + c * c) + 3 * (s[0][1] * s[0][1] + s[1][2] * s[1][2] + s[2][0] * s[2][0]));
}

}  // namespace frontalis
