#pragma once

#include "frontalis/model/model.hpp"
#include "frontalis/physics/trilinear.hpp"

#include <array>
#include <cstddef>

namespace frontalis
{

/// Displacement [m] of a point tied to a voxel. `point`: index in the binding; `u`: displacements of nodes, per axis
/// [m].
template <class Real>
std::array<double, 3> bound_displacement(const Model& model, const Binding& binding, std::size_t point,
                                         const Real* const u[3])
{
  const auto& c = binding.coordinates[point];
  double weight[8];
  physics::trilinear_weights<double>(c[0], c[1], c[2], weight);
  const auto& nodes = model.voxel_nodes[binding.voxel[point]];
  std::array<double, 3> sum{ { 0, 0, 0 } };
  for (int b = 0; b < 8; ++b)
    for (int axis = 0; axis < 3; ++axis)
      sum[axis] += weight[b] * u[axis][nodes[b]];
  return sum;
}

}  // namespace frontalis
