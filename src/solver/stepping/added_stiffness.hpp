#pragma once

#include "frontalis/model/model.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace frontalis
{

/// Stiffness that an effect adds to that of voxels, for the bound of the highest frequency.
class AddedStiffness
{
public:
  virtual ~AddedStiffness() = default;

  /// What it adds to the bound of a voxel's stiffness [N/m].
  virtual double in_voxel(std::size_t voxel) const = 0;
  /// Adds the internal forces [N] of this stiffness at its largest, at displacements [m].
  virtual void add_forces(const Model& model, const std::vector<std::array<double, 3>>& displacements,
                          std::vector<std::array<double, 3>>& forces) const = 0;

protected:
  AddedStiffness() = default;
  AddedStiffness(const AddedStiffness&) = default;
  AddedStiffness& operator=(const AddedStiffness&) = default;
};

}  // namespace frontalis
