#pragma once

#include "solver/stepping/array_list.hpp"

#include "frontalis/model/model.hpp"

#include <vector>

namespace frontalis
{

/// Largest ratio of the displacement of a point to the largest displacement of a node of its voxel; at least 1.
/// `coordinates`: the point's position in the voxel.
double spread_at(const std::array<float, 3>& coordinates);

/// Finds how far the nodes to which points are bound move in a step.
class BoundNodeWay
{
public:
  BoundNodeWay() = default;
  BoundNodeWay(const Model& model, const Binding& points);

  /// Longest displacement [m] of a bound node of a plane in a step, from displacements before and after it.
  template <class Real>
  double in_plane(std::int32_t plane, const Real* const before[3], const Real* const after[3]) const;
  /// Largest spread_at() of a point.
  double spread() const { return spread_; }
  void list_arrays(ArrayList& list, Effect effect) const;

private:
  // The nodes [first, last), nearly all of which are bound.
  struct Run
  {
    std::int32_t first, last;
  };
  double spread_ = 1;
  std::vector<Run> runs_;  // runs that contain all bound nodes, ascending
  // first run in each plane of nodes; the last two entries are the number of runs
  std::vector<std::int32_t> plane_runs_;
};

}  // namespace frontalis
