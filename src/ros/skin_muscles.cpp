#include "frontalis/ros/skin_muscles.hpp"

#include "frontalis/render/renderer.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

namespace frontalis
{

SkinMuscles::SkinMuscles(const Model& model, double depth)
{
  const auto& size = model.size;
  const auto place_of = [&](const std::array<std::int32_t, 3>& v)
  { return (static_cast<std::size_t>(v[2]) * size[1] + v[1]) * size[0] + v[0]; };
  // Where a gap parts tissue, two voxels have the same place.
  std::unordered_multimap<std::size_t, std::int32_t> voxels_at;
  for (std::size_t e = 0; e + 1 < model.fibre_begin.size(); ++e)
    voxels_at.emplace(place_of(rest_place(model, model.voxels[e])), static_cast<std::int32_t>(e));

  RenderMesh mesh;
  mesh.triangles = model.skin.triangles;
  for (const auto& [x, y, z] : model.skin.vertices)
    mesh.vertices.push_back({ { static_cast<float>(x), static_cast<float>(y), static_cast<float>(z) } });
  const auto normals = normals_of(mesh);

  const double step = 0.5 * *std::min_element(model.spacing.begin(), model.spacing.end());
  begin_.push_back(0);
  for (std::size_t vertex = 0; vertex < mesh.vertices.size(); ++vertex)
  {
    std::map<std::size_t, double> found;
    double sum = 0;
    for (double below = 0; below <= depth; below += step)
    {
      std::array<std::int32_t, 3> at{};
      bool inside = true;
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        const double x = model.skin.vertices[vertex][axis] - below * static_cast<double>(normals[vertex][axis]);
        at[axis] = static_cast<std::int32_t>(std::floor(x / model.spacing[axis]));
        inside = inside && at[axis] >= 0 && at[axis] < size[axis];
      }
      if (!inside)
        continue;
      const auto here = voxels_at.equal_range(place_of(at));
      for (auto voxel = here.first; voxel != here.second; ++voxel)
        for (auto fibre = model.fibre_begin[voxel->second]; fibre < model.fibre_begin[voxel->second + 1]; ++fibre)
        {
          const auto weight = static_cast<double>(model.fibre_weight[fibre]);
          if (weight <= 0)
            continue;
          found[static_cast<std::size_t>(model.fibre_muscle[fibre])] += weight;
          sum += weight;
        }
    }
    for (const auto& [muscle, weight] : found)
      shares_.push_back({ muscle, static_cast<float>(weight / sum) });
    begin_.push_back(shares_.size());
  }
}

std::vector<float> SkinMuscles::activation(const std::vector<float>& activation) const
{
  std::vector<float> out(begin_.size() - 1, 0.0f);
  for (std::size_t vertex = 0; vertex < out.size(); ++vertex)
    for (std::size_t entry = begin_[vertex]; entry < begin_[vertex + 1]; ++entry)
      out[vertex] += shares_[entry].weight * activation.at(shares_[entry].muscle);
  return out;
}

}  // namespace frontalis
