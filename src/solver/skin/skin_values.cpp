#include "solver/skin/skin_values.hpp"

#include "frontalis/error.hpp"
#include "frontalis/physics/symmetric_eigen.hpp"
#include "frontalis/physics/trilinear.hpp"
#include "frontalis/solver/solver.hpp"
#include "solver/voxel_centre.hpp"

#include <algorithm>

namespace frontalis
{
namespace
{

// Largest eigenvalue of the Green-Lagrange strain.
double principal_strain(const physics::Kinematics<double>& k)
{
  const auto eigen = physics::symmetric_eigen(green_lagrange_strain(k));
  return *std::max_element(eigen.value, eigen.value + 3);
}

}  // namespace

SkinField skin_field_from_name(const std::string& name)
{
  if (name == "strain")
    return SkinField::strain;
  if (name == "stress")
    return SkinField::stress;
  if (name == "lines")
    return SkinField::lines;
  throw Error("there is no field '" + name + "' of the skin; the fields are strain, stress, lines");
}

SkinValues::SkinValues(const Model& model, const Discretisation& discretisation)
    : model_(model), discretisation_(discretisation)
{
  std::vector<std::int32_t> rank(model.nodes.size(), -1);
  for (const auto voxel : model.skin_binding.voxel)
    for (const auto node : model.voxel_nodes[voxel])
      rank[node] = 0;
  for (std::size_t n = 0; n < rank.size(); ++n)
    if (rank[n] == 0)
    {
      rank[n] = static_cast<std::int32_t>(nodes_.size());
      nodes_.push_back(static_cast<std::int32_t>(n));
    }
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    std::array<std::int32_t, 8> corner;
    for (std::size_t b = 0; b < 8; ++b)
      corner[b] = rank[model.voxel_nodes[e][b]];
    if (std::all_of(corner.begin(), corner.end(), [](auto r) { return r < 0; }))
      continue;
    voxels_.push_back(static_cast<std::int32_t>(e));
    corner_.push_back(corner);
  }
}

void SkinValues::compute(SkinField field, const std::vector<std::array<double, 3>>& u,
                         const std::vector<float>& activation, EffectSet running, std::vector<float>& out)
{
  sum_.assign(nodes_.size(), 0);
  weight_.assign(nodes_.size(), 0);
  VoxelProperties voxel;
  for (std::size_t v = 0; v < voxels_.size(); ++v)
  {
    const auto e = static_cast<std::size_t>(voxels_[v]);
    discretisation_.voxel(e, voxel);
    const auto k = deformation_at_centre(model_, voxel, e, u);
    double value = 0;
    if (field == SkinField::strain)
      value = principal_strain(k);
    else if (field == SkinField::stress)
      value = von_mises(cauchy_stress({ model_, discretisation_, voxel, e, &activation, running }, k));
    const double tissue = static_cast<double>(model_.fill[e]);
    for (const auto rank : corner_[v])
      if (rank >= 0)
      {
        sum_[rank] += tissue * value;
        weight_[rank] += tissue;
      }
  }
  for (std::size_t n = 0; n < nodes_.size(); ++n)
    sum_[n] /= weight_[n];
  const auto& binding = model_.skin_binding;
  out.resize(binding.voxel.size());
  for (std::size_t p = 0; p < out.size(); ++p)
  {
    // A vertex outside its voxel gets the value at the nearest point of the voxel.
    const auto inside = [](float x) { return std::clamp(static_cast<double>(x), 0.0, 1.0); };
    const auto& c = binding.coordinates[p];
    double weight[8];
    physics::trilinear_weights<double>(inside(c[0]), inside(c[1]), inside(c[2]), weight);
    const auto v = std::lower_bound(voxels_.begin(), voxels_.end(), binding.voxel[p]) - voxels_.begin();
    double value = 0;
    for (int b = 0; b < 8; ++b)
      value += weight[b] * sum_[corner_[v][b]];
    out[p] = static_cast<float>(value);
  }
}

void SkinValues::list_arrays(ArrayList& list) const
{
  list.add(Effect::output_fields, "nodes below the skin", nodes_);
  list.add(Effect::output_fields, "voxels below the skin", voxels_);
  list.add(Effect::output_fields, "voxels below the skin", corner_);
  list.add(Effect::output_fields, "means at nodes", sum_);
  list.add(Effect::output_fields, "means at nodes", weight_);
}

}  // namespace frontalis
