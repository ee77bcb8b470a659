#pragma once

#include "frontalis/model/model.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace frontalis
{

using Vectors = std::vector<std::array<double, 3>>;

/// A neo-Hookean material of Young's modulus [Pa] and Poisson's ratio, density in kg/m3.
Material neo_hookean(double young, double poisson, double density = 1000);
double shear_modulus(double young, double poisson);
double bulk_modulus(double young, double poisson);

/// Voxels of a box, for studies.
struct VoxelBox
{
  std::array<std::int32_t, 3> size{ { 1, 1, 1 } };
  std::array<double, 3> spacing{ { 1e-3, 1e-3, 1e-3 } };  ///< [m]
  std::vector<Material> materials;
  /// Proportion of tissue in voxel (i,j,k), 0: none there; empty: all whole.
  std::function<double(const std::array<std::int32_t, 3>&)> fill;
  /// Index of its material; empty: the first.
  std::function<int(const std::array<std::int32_t, 3>&)> material;
};

/// Throws Error as build_nodes does.
Model voxel_model(const VoxelBox& box);

/// Gives every voxel one muscle; direction(e) is the fibre's in voxel e, length 1.
void add_muscle(Model& model, const Muscle& muscle, const std::function<std::array<float, 3>(std::size_t)>& direction);

/// Position of a node at rest [m].
std::array<double, 3> rest_position(const Model& model, std::size_t node);

/// Nodes for which the condition on their position at rest [m] holds, ascending.
std::vector<std::int32_t> nodes_where(const Model& model,
                                      const std::function<bool(const std::array<double, 3>&)>& condition);

/// Prescribes components of the displacement [m] of nodes, reached linearly over `ramp` [s].
void prescribe(Model& model, const std::vector<std::int32_t>& nodes, const std::array<bool, 3>& components,
               const std::array<double, 3>& displacement = { { 0, 0, 0 } }, double ramp = 0);

}  // namespace frontalis
