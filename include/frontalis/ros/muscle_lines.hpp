#pragma once

#include "frontalis/model/model.hpp"

#include <visualization_msgs/MarkerArray.h>

#include <array>
#include <cstddef>
#include <vector>

namespace frontalis
{

/// The muscles as short lines along their fibres, which move with the tissue, coloured by activation. One marker per
/// muscle, whose namespace is the muscle's name, so that rviz can hide each.
class MuscleLines
{
public:
  /// Chooses at most `most` voxels per muscle, evenly.
  explicit MuscleLines(const Model& model, std::size_t most = 300);

  /// Fills all but the headers. `displacements`: of the nodes, in the local frame [m].
  void fill(const Model& model, const std::vector<std::array<double, 3>>& displacements,
            const std::vector<float>& activation, visualization_msgs::MarkerArray& out) const;

private:
  struct Line
  {
    std::size_t voxel;
    std::array<std::array<double, 3>, 2> ends;  ///< as fractions of the voxel's edges, 0..1
  };
  std::vector<std::vector<Line>> lines_;  ///< by muscle
};

}  // namespace frontalis
