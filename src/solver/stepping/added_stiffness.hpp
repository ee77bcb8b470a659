#pragma once

#include "frontalis/model/model.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace frontalis
{

/// Stiffness that an effect adds to that of voxels. The bound of the highest frequency includes it.
class AddedStiffness
{
public:
  virtual ~AddedStiffness() = default;

  /// Its part of the bound of a voxel's stiffness [N/m].
  virtual double in_voxel(std::size_t voxel) const = 0;
  /// Adds its internal forces [N] at displacements [m], where it is largest.
  virtual void add_forces(const Model& model, const std::vector<std::array<double, 3>>& displacements,
                          std::vector<std::array<double, 3>>& forces) const = 0;

protected:
  AddedStiffness() = default;
  AddedStiffness(const AddedStiffness&) = default;
  AddedStiffness& operator=(const AddedStiffness&) = default;
};

}  // namespace frontalis
