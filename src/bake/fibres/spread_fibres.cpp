#include "bake/fibres/fibres.hpp"
#include "bake/voxels/voxel_index.hpp"

#include <map>

namespace frontalis
{

void spread_fibres(Model& model)
{
  constexpr float least = 1e-3f;  // smaller parts of a voxel are left out
  struct Part
  {
    double volume = 0;  // volume of the muscle in voxels
    Vector3d direction{ 0, 0, 0 };
  };
  const VoxelIndex index(model.voxels, model.size);
  std::vector<std::map<std::int16_t, Part>> parts(model.voxels.size());
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    if (model.fibre_begin[e] == model.fibre_begin[e + 1])
      continue;
    std::vector<std::pair<std::int32_t, double>> around;
    double sum = 0;
    for (int i = 0; i < 27; ++i)
    {
      const std::array<std::int32_t, 3> step{ { i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1 } };
      const auto& v = model.voxels[e];
      const std::int32_t neighbour = index.find({ { v[0] + step[0], v[1] + step[1], v[2] + step[2] } });
      if (neighbour < 0)
        continue;
      double weight = static_cast<double>(model.fill[neighbour]);
      for (const std::int32_t s : step)
        weight *= s == 0 ? 2 : 1;
      around.emplace_back(neighbour, weight);
      sum += weight;
    }
    for (std::int32_t f = model.fibre_begin[e]; f < model.fibre_begin[e + 1]; ++f)
    {
      const double volume = static_cast<double>(model.fill[e]) * static_cast<double>(model.fibre_weight[f]);
      const Vector3d direction = Eigen::Map<const Eigen::Vector3f>(model.fibre_direction[f].data()).cast<double>();
      for (const auto& [neighbour, weight] : around)
      {
        Part& part = parts[neighbour][model.fibre_muscle[f]];
        const double share = volume * weight / sum;
        part.volume += share;
        part.direction += (part.direction.dot(direction) < 0 ? -share : share) * direction;
      }
    }
  }
  model.fibre_begin.assign(1, 0);
  model.fibre_muscle.clear();
  model.fibre_weight.clear();
  model.fibre_direction.clear();
  for (std::size_t e = 0; e < parts.size(); ++e)
  {
    for (const auto& [muscle, part] : parts[e])
    {
      const auto weight = std::min(1.0f, static_cast<float>(part.volume) / model.fill[e]);
      if (weight < least || part.direction.norm() < 1e-12)
        continue;
      model.fibre_muscle.push_back(muscle);
      model.fibre_weight.push_back(weight);
      Eigen::Map<Eigen::Vector3f>(model.fibre_direction.emplace_back().data()) =
          part.direction.normalized().cast<float>();
    }
    model.fibre_begin.push_back(static_cast<std::int32_t>(model.fibre_muscle.size()));
  }
}

}  // namespace frontalis
