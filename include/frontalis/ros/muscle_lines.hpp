#pragma once

#include "frontalis/model/model.hpp"

#include <visualization_msgs/MarkerArray.h>

#include <array>
#include <cstddef>
#include <vector>

namespace frontalis
{

/// Draws muscles as short lines along their fibres, which move with the tissue and are coloured by activation. Each
/// muscle is a marker with a namespace of its own, the muscle's name, so that rviz can hide it.
class MuscleLines
{
public:
  /// Draws lines in at most `most` voxels per muscle, which are chosen at equal distances in the list of voxels.
  explicit MuscleLines(const Model& model, std::size_t most = 300);

  /// Fills all but the headers. `displacements`: displacements of the nodes in the local frame [m].
  void fill(const Model& model, const std::vector<std::array<double, 3>>& displacements,
            const std::vector<float>& activation, visualization_msgs::MarkerArray& out) const;

private:
  struct Line
  {
    std::size_t voxel;
    std::array<std::array<double, 3>, 2> ends;  ///< positions of the ends as fractions of the voxel's edges, 0..1
  };
  std::vector<std::vector<Line>> lines_;  ///< lines of each muscle
};

}  // namespace frontalis
