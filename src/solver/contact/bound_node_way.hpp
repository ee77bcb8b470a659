#pragma once

#include "solver/stepping/array_list.hpp"

#include "frontalis/model/model.hpp"

#include <vector>

namespace frontalis
{

/// Finds how far the nodes of bound points move in a step.
class BoundNodeWay
{
public:
  /// `voxels`: those of the points.
  BoundNodeWay(const Model& model, const std::vector<std::int32_t>& voxels);

  /// Longest way [m] of a bound node in a plane of nodes, from displacements before and after the step.
  template <class Real>
  double in_plane(std::int32_t plane, const Real* const before[3], const Real* const after[3]) const;
  void list_arrays(ArrayList& list, Effect effect) const;

private:
  // nodes [first, last), among which bound ones are not far apart
  struct Run
  {
    std::int32_t first, last;
  };
  std::vector<Run> runs_;                 // ascending
  std::vector<std::int32_t> plane_runs_;  // first of them in each plane of nodes, and their number
};

}  // namespace frontalis
