#include "frontalis/ros/muscle_lines.hpp"

#include "frontalis/ros/shading.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{

MuscleLines::MuscleLines(const Model& model, std::size_t most) : lines_(model.muscles.size())
{
  for (std::size_t voxel = 0; voxel + 1 < model.fibre_begin.size(); ++voxel)
    for (auto fibre = model.fibre_begin[voxel]; fibre < model.fibre_begin[voxel + 1]; ++fibre)
    {
      // The line runs from the voxel's centre in both directions, up to the sides of the voxel.
      const auto& direction = model.fibre_direction[static_cast<std::size_t>(fibre)];
      const double longest =
          std::max({ std::abs(direction[0]), std::abs(direction[1]), std::abs(direction[2]), 1e-6f });
      Line line{ voxel, {} };
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        line.ends[0][axis] = 0.5 - 0.5 * direction[axis] / longest;
        line.ends[1][axis] = 0.5 + 0.5 * direction[axis] / longest;
      }
      lines_[static_cast<std::size_t>(model.fibre_muscle[static_cast<std::size_t>(fibre)])].push_back(line);
    }
  for (auto& lines : lines_)
    if (const std::size_t stride = (lines.size() + most - 1) / most; stride > 1)
    {
      for (std::size_t kept = 0; kept * stride < lines.size(); ++kept)
        lines[kept] = lines[kept * stride];
      lines.resize((lines.size() + stride - 1) / stride);
    }
}

void MuscleLines::fill(const Model& model, const std::vector<std::array<double, 3>>& displacements,
                       const std::vector<float>& activation, visualization_msgs::MarkerArray& out) const
{
  out.markers.resize(lines_.size());
  for (std::size_t muscle = 0; muscle < lines_.size(); ++muscle)
  {
    visualization_msgs::Marker& marker = out.markers[muscle];
    marker.ns = model.muscles[muscle].name;
    marker.type = visualization_msgs::Marker::LINE_LIST;
    marker.action = visualization_msgs::Marker::ADD;
    marker.pose.orientation.w = 1;
    marker.scale.x = 0.25 * model.spacing[0];
    const auto colour = false_colour(activation[muscle]);
    marker.color.r = std::sqrt(colour[0]);
    marker.color.g = std::sqrt(colour[1]);
    marker.color.b = std::sqrt(colour[2]);
    marker.color.a = 1;
    marker.points.clear();
    for (const Line& line : lines_[muscle])
    {
      const auto place = rest_place(model, model.voxels[line.voxel]);
      for (const auto& end : line.ends)
      {
        std::array<double, 3> at{};
        for (std::size_t axis = 0; axis < 3; ++axis)
          at[axis] = (place[axis] + end[axis]) * model.spacing[axis];
        for (std::size_t corner = 0; corner < 8; ++corner)
        {
          double share = 1;
          for (std::size_t axis = 0; axis < 3; ++axis)
            share *= (corner >> axis & 1) != 0 ? end[axis] : 1 - end[axis];
          const auto node = static_cast<std::size_t>(model.voxel_nodes[line.voxel][corner]);
          for (std::size_t axis = 0; axis < 3; ++axis)
            at[axis] += share * displacements[node][axis];
        }
        const auto point = model.to_face(at);
        auto& to = marker.points.emplace_back();
        to.x = point[0];
        to.y = point[1];
        to.z = point[2];
      }
    }
  }
}

}  // namespace frontalis
