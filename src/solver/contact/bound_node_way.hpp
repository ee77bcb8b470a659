#pragma once

#include "solver/stepping/array_list.hpp"

#include "frontalis/model/model.hpp"

#include <vector>

namespace frontalis
{

/// Finds how far points that are bound to nodes move in a step.
class BoundNodeWay
{
public:
  BoundNodeWay() = default;
  BoundNodeWay(const Model& model, const Binding& points);

  /// Contribution of a plane of nodes to an upper bound of the points' motion in a step [m], from displacements before
  /// and after it: no point moves farther than the largest contribution.
  template <class Real>
  double in_plane(std::int32_t plane, const Real* const before[3], const Real* const after[3]) const;
  /// Largest ratio of a point's displacement to the largest displacement of a node of its voxel.
  double spread() const { return spread_; }
  void list_arrays(ArrayList& list, Effect effect) const;

private:
  // The nodes [first, last), most of which are bound.
  struct Run
  {
    std::int32_t first, last;
  };
  double spread_ = 1;
  // Squared factor on each node's motion. A point whose weights are w moves by at most the sum of |w| times its nodes'
  // motions. This is at most the largest product of a node's factor and motion, because each factor is at least
  // sqrt(|w|) times the sum of sqrt(|w|). It is small where all points are far from the node.
  std::vector<float> factor_;
  std::vector<Run> runs_;  // runs that contain all bound nodes, ascending
  // first run in each plane of nodes; the last two entries are the number of runs
  std::vector<std::int32_t> plane_runs_;
};

}  // namespace frontalis
