#pragma once

#include "frontalis/model/model.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace frontalis
{

class Discretisation;

/// Symmetric stiffness matrix of points that are bound to voxels. It is the same along all axes.
struct PointStiffness
{
  struct Entry
  {
    std::int32_t row, column;  ///< points
    double value;              ///< [N/m]; entries of the same place add up
  };
  const Binding* binding;
  std::vector<Entry> entries;
};

/// Stiffness that an effect adds to that of voxels, for the bound of the highest frequency.
class AddedStiffness
{
public:
  virtual ~AddedStiffness() = default;

  /// What the effect adds to the bound of a voxel's stiffness [N/m].
  virtual double in_voxel(std::size_t voxel) const = 0;
  /// The stiffness at its largest value.
  virtual std::vector<PointStiffness> matrices() const = 0;

  /// Increases the stiffness where this does not raise the bound of the highest frequency, because nodes elsewhere
  /// determine the bound. Call it once the masses and the bound are known.
  virtual void stiffen(const Model& /*model*/, const Discretisation& /*discretisation*/) {}
  /// Longest stable step of masses that are not nodes [s].
  virtual double longest_step() const { return std::numeric_limits<double>::infinity(); }

protected:
  AddedStiffness() = default;
  AddedStiffness(const AddedStiffness&) = default;
  AddedStiffness& operator=(const AddedStiffness&) = default;
};

}  // namespace frontalis
