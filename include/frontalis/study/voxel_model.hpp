#pragma once

#include "frontalis/model/model.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace frontalis
{

using Vectors = std::vector<std::array<double, 3>>;

/// A neo-Hookean material of Young's modulus [Pa], Poisson's ratio and density [kg/m3].
Material neo_hookean(double young, double poisson, double density = 1000);
double shear_modulus(double young, double poisson);
double bulk_modulus(double young, double poisson);

/// A box of voxels, for studies.
struct VoxelBox
{
  std::array<std::int32_t, 3> size{ { 1, 1, 1 } };
  std::array<double, 3> spacing{ { 1e-3, 1e-3, 1e-3 } };  ///< [m]
  std::vector<Material> materials;
  /// Proportion of tissue in voxel (i,j,k), 0: there is no voxel; empty: all are whole.
  std::function<double(const std::array<std::int32_t, 3>&)> fill;
  /// Index of its material; empty: the first.
  std::function<int(const std::array<std::int32_t, 3>&)> material;
};

/// The model of a box, and of a box of whole cubic voxels of one material. Throws Error as build_nodes does.
Model voxel_model(const VoxelBox& box);
Model voxel_model(const std::array<std::int32_t, 3>& size, double edge, const Material& material);

/// Gives every voxel fibres of one muscle; direction(e) is theirs in voxel e, of length 1.
void add_muscle(Model& model, const Muscle& muscle, const std::function<std::array<float, 3>(std::size_t)>& direction);

/// Displacements [m] that deform the whole model by one gradient (row by row) and move it by `shift` [m].
Vectors affine_displacements(const Model& model, const std::array<double, 9>& gradient,
                             const std::array<double, 3>& shift = { { 0, 0, 0 } });

/// Nodes for which the condition on their position at rest [m] holds, ascending.
std::vector<std::int32_t> nodes_where(const Model& model,
                                      const std::function<bool(const std::array<double, 3>&)>& condition);

/// Prescribes components of the displacement [m] of nodes, reached linearly over `ramp` [s].
void prescribe(Model& model, const std::vector<std::int32_t>& nodes, const std::array<bool, 3>& components,
               const std::array<double, 3>& displacement = { { 0, 0, 0 } }, double ramp = 0);

/// Keeps the nodes of the planes x = 0, y = 0 and z = 0 in their planes, as where a body is mirrored in all three.
void hold_mirror_planes(Model& model);

}  // namespace frontalis
