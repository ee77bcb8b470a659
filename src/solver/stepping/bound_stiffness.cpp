#include "solver/stepping/bound_stiffness.hpp"

#include "frontalis/physics/trilinear.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{

void add_stiffness_rows(const Model& model, const Binding& points, const std::vector<float>& stiffness, double factor,
                        std::vector<double>& rows)
{
  for (std::size_t p = 0; p < stiffness.size(); ++p)
  {
    const auto& at = points.coordinates[p];
    double weight[8], sum = 0;
    physics::trilinear_weights<double>(at[0], at[1], at[2], weight);
    for (const double w : weight)
      sum += std::abs(w);
    for (std::size_t b = 0; b < 8; ++b)
      rows[model.voxel_nodes[points.voxel[p]][b]] += factor * double(stiffness[p]) * std::abs(weight[b]) * sum;
  }
}

void share_rows(const Model& model, const std::vector<double>& rows, const std::vector<double>& of_voxels,
                std::vector<float>& voxels)
{
  for (std::size_t e = 0; e < voxels.size(); ++e)
  {
    double share = 0;
    for (const auto node : model.voxel_nodes[e])
      share = std::max(share, rows[node] / of_voxels[node]);
    voxels[e] *= static_cast<float>(share);
  }
}

}  // namespace frontalis
