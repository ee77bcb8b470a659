#pragma once

#include "solver/stepping/added_stiffness.hpp"

namespace frontalis
{

class Discretisation;

/// Stiffness of contact (physics/contact.hpp), and what it adds to the bound of the highest frequency, as if all points
/// touched at once: the bound is right at the moment when a point touches.
class ContactStiffness : public AddedStiffness
{
public:
  /// From the mixtures of the points' voxels, with bounds of their stiffness that do not include contact.
  ContactStiffness(const Model& model, const Discretisation& discretisation);

  /// Of a point [N/m].
  double of(std::size_t contact, std::size_t point) const { return points_[contact][point]; }
  /// Contact's part of the bound of a voxel's stiffness [N/m]. In tissue of Poisson's ratio 0.49 it is at most 7 % of
  /// the voxel's own.
  double in_voxel(std::size_t voxel) const override { return double(voxels_[voxel]); }
  /// Adds the internal forces [N] of points that all touch and stick, and are as stiff along the surface as along its
  /// normal, at displacements [m].
  void add_forces(const Model& model, const std::vector<std::array<double, 3>>& displacements,
                  std::vector<std::array<double, 3>>& forces) const override;

private:
  std::vector<double> rows(const Model& model) const;

  std::vector<std::vector<float>> points_;  // [N/m] of each contact's points
  std::vector<float> voxels_;               // [N/m]
};

}  // namespace frontalis
