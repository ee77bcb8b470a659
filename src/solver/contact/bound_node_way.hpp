#pragma once

#include "solver/stepping/array_list.hpp"

#include "frontalis/model/model.hpp"

#include <cstdint>
#include <vector>

namespace frontalis
{

/// Largest ratio of the displacement of a point to the largest displacement of a node of its voxel; at least 1.
/// `coordinates`: the point's position in the voxel.
double spread_at(const std::array<float, 3>& coordinates);

/// Finds how far points that are bound to nodes, or these nodes, move in a step.
class BoundNodeWay
{
public:
  enum class Of : std::uint8_t
  {
    nodes,  ///< the motion of the nodes; a point moves by at most spread_at() as far
    points  ///< a bound of the motion of the points themselves
  };

  BoundNodeWay() = default;
  BoundNodeWay(const Model& model, const Binding& points, Of of);

  /// Contribution of a plane of nodes to the longest way in a step [m], from displacements before and after it.
  template <class Real>
  double in_plane(std::int32_t plane, const Real* const before[3], const Real* const after[3]) const;
  /// Largest spread_at() of a point.
  double spread() const { return spread_; }
  void list_arrays(ArrayList& list, Effect effect) const;

private:
  // The nodes [first, last), most of which are bound.
  struct Run
  {
    std::int32_t first, last;
  };
  double spread_ = 1;
  // Squared factor on each node's motion, 1 if the way is that of nodes. A point whose weights are w moves by at most
  // the sum of |w| times its nodes' motions. This is at most the largest product of a node's factor and motion, because
  // each factor is at least sqrt(|w|) times the sum of sqrt(|w|). It is small where all points are far from the node.
  std::vector<float> factor_;
  std::vector<Run> runs_;  // runs that contain all bound nodes, ascending
  // first run in each plane of nodes; the last two entries are the number of runs
  std::vector<std::int32_t> plane_runs_;
};

}  // namespace frontalis
