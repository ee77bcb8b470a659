#pragma once

#include "frontalis/model/model.hpp"

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

namespace frontalis
{

class Discretisation;

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

  /// Uses what nodes elsewhere leave: where they set the bound of the highest frequency, stiffness may grow as far as that
  /// bound does not. To be called once masses and this bound are known.
  virtual void stiffen(const Model& /*model*/, const Discretisation& /*discretisation*/) {}
  /// Longest stable step of masses that are not nodes [s].
  virtual double longest_step() const { return std::numeric_limits<double>::infinity(); }

protected:
  AddedStiffness() = default;
  AddedStiffness(const AddedStiffness&) = default;
  AddedStiffness& operator=(const AddedStiffness&) = default;
};

}  // namespace frontalis
