#pragma once

#include "frontalis/study/voxel_model.hpp"
#include "study/stability/stability_file.hpp"

#include <utility>

namespace frontalis
{

/// The hypodermis of the published forehead, at the density of tissue.
Material soft_tissue(double poisson = 0.49);

/// A box of voxels of soft tissue, edge 1 mm; of the size, and the size and damping, that a case's file gives.
Model soft_block(const std::array<std::int32_t, 3>& size);
Model damped_block(const CaseFile& file);

/// Makes nodes rigid that fulfil a condition on their position at rest [m]: still, or moved by the bone of that name.
void hold(Model& model, const std::function<bool(const std::array<double, 3>&)>& condition,
          const std::string& bone = {});
/// The same for the lowest or the highest plane of nodes along an axis.
void hold_face(Model& model, int axis, bool upper, const std::string& bone = {});

/// Sets the mixture of each voxel: materials and their proportions.
void mix(Model& model, const std::function<std::vector<std::pair<int, float>>(std::size_t)>& mixture);

/// A fibre of a voxel: muscle, direction of length 1, share of the voxel.
struct Fibre
{
  int muscle;
  std::array<float, 3> direction;
  float weight = 1;
};
void add_muscles(Model& model, const std::vector<Muscle>& muscles,
                 const std::function<std::vector<Fibre>(std::size_t)>& fibres);
/// The direction of fibres along x, for add_muscle().
std::array<float, 3> along_x(std::size_t voxel);

/// Displacements that move every node to map(position at rest) [m].
Vectors displaced(const Model& model, const std::function<std::array<double, 3>(const std::array<double, 3>&)>& map);

/// Largest of |a - b| [m] over all nodes.
double farthest(const Vectors& a, const Vectors& b);
double farthest(const Vectors& a);

/// Rigid motion by a rotation vector [rad] about a point [m].
RigidTransform turned_about(const std::array<double, 3>& rotation, const std::array<double, 3>& point);

}  // namespace frontalis
