#pragma once

#include "solver/stepping/added_stiffness.hpp"

namespace frontalis
{

class Discretisation;

/// Stiffness of contact (physics/contact.hpp), and its contribution to the bound of the highest frequency. All points
/// count as if they touched, so that the bound holds already when a point begins to touch.
class ContactStiffness : public AddedStiffness
{
public:
  /// Computes the stiffness from the mixtures of the points' voxels. The discretisation's bounds must not include
  /// contact yet.
  ContactStiffness(const Model& model, const Discretisation& discretisation);

  /// Makes points of Model::contacts up to ten times as stiff, but not those of self-contact.
  void stiffen(const Model& model, const Discretisation& discretisation) override;

  /// Stiffness [N/m] of a point of one of Model::contacts.
  double of(std::size_t contact, std::size_t point) const { return double(surfaces_[contact].points[point]); }
  /// Stiffness [N/m] of a vertex of one of Model::self_contacts.
  double of_self(std::size_t contact, std::size_t vertex) const { return of(bodies_ + contact, vertex); }
  /// Contact's part of the bound of a voxel's stiffness [N/m]. In tissue with a Poisson's ratio of 0.49 it is at most
  /// 7 % of the voxel's own stiffness.
  double in_voxel(std::size_t voxel) const override { return double(voxels_[voxel]); }
  /// All points touch, stick, and are as stiff along the surface as along its normal.
  std::vector<PointStiffness> matrices() const override;

  /// Longest stable step of bodies that are pushed [s].
  double longest_step() const override { return longest_step_; }
  std::vector<EnergySupply> supplies() const override { return supplies_; }

private:
  struct Surface
  {
    const Binding* binding;
    std::vector<float> points;  // [N/m]
    // Factor with which the stiffness counts: 2 if the other side is tissue, because a spring between two masses acts
    // on both.
    double moves;
  };
  void add(const Binding& binding, const std::vector<double>& area, const std::vector<double>& per_area, double moves);
  void share_out(const Model& model, const std::vector<double>& of_voxels);
  /// Sums of absolute stiffness per node (add_stiffness_rows()). `alone`: as if the other side stood still.
  std::vector<double> rows(const Model& model, bool alone) const;

  std::vector<Surface> surfaces_;  // surfaces of Model::contacts, then those of Model::self_contacts
  std::size_t bodies_;
  std::vector<float> voxels_;  // [N/m]
  std::vector<EnergySupply> supplies_;
  double longest_step_ = std::numeric_limits<double>::infinity();
};

}  // namespace frontalis
