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

/// A body that brings energy to tissue.
struct EnergySupply
{
  std::int32_t bone;     ///< that moves the body; -1: none
  const Binding* bound;  ///< points that may touch it
  double spring;         ///< between bone and body [N/m]; 0: none
  double push;           ///< root of f^2 / (2 m), of the force on the body and its mass [sqrt(J)/s]
};

/// Stiffness that an effect adds to that of voxels, for the bound of the highest frequency, and the energy that the
/// effect can supply.
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
  /// Energy that the effect stores at rest [J], such as that of creases.
  virtual double energy_at_rest() const { return 0; }
  virtual std::vector<EnergySupply> supplies() const { return {}; }
  /// Longest stable step of masses that are not nodes [s].
  virtual double longest_step() const { return std::numeric_limits<double>::infinity(); }

protected:
  AddedStiffness() = default;
  AddedStiffness(const AddedStiffness&) = default;
  AddedStiffness& operator=(const AddedStiffness&) = default;
};

}  // namespace frontalis
