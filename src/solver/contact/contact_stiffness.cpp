#include "solver/contact/contact_stiffness.hpp"

#include "frontalis/physics/contact.hpp"
#include "frontalis/physics/hourglass.hpp"
#include "frontalis/physics/trilinear.hpp"
#include "solver/stepping/discretisation.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

double young_modulus(const VoxelProperties& voxel)
{
  double shear = voxel.mu;
  for (const LawPart& part : voxel.laws)
    shear += part.weight * part.stiffness_at_rest;
  return physics::young_modulus(shear, voxel.kappa);
}

}  // namespace

ContactStiffness::ContactStiffness(const Model& model, const Discretisation& discretisation)
{
  if (model.contacts.empty())
    return;
  const double edge = *std::min_element(model.spacing.begin(), model.spacing.end());
  // The stiffness of a point on the nodes of its voxel is k w w^T, w its weights. Its rows, added over the points of a
  // voxel, bound the largest eigenvalue of their sum (Gershgorin).
  std::vector<std::array<float, 8>> rows(model.voxels.size(), std::array<float, 8>{});
  VoxelProperties properties;
  for (const Contact& contact : model.contacts)
  {
    auto& points = points_.emplace_back();
    for (std::size_t p = 0; p < contact.points.size(); ++p)
    {
      const auto voxel = contact.binding.voxel[p];
      discretisation.voxel(static_cast<std::size_t>(voxel), properties);
      points.push_back(
          static_cast<float>(physics::contact_stiffness * young_modulus(properties) / edge * contact.area[p]));
      const auto& c = contact.binding.coordinates[p];
      float weight[8], sum = 0;
      physics::trilinear_weights(c[0], c[1], c[2], weight);
      for (const float w : weight)
        sum += std::abs(w);
      for (std::size_t b = 0; b < 8; ++b)
        rows[voxel][b] += points.back() * std::abs(weight[b]) * sum;
    }
  }
  // points far outside of their voxel have large weights, which would shorten the steps: they are softer
  voxels_.assign(model.voxels.size(), 0);
  std::vector<float> share(model.voxels.size(), 1);
  for (std::size_t e = 0; e < rows.size(); ++e)
  {
    const float largest = *std::max_element(rows[e].begin(), rows[e].end());
    if (!(largest > 0))
      continue;
    discretisation.voxel(e, properties);
    share[e] = std::min(1.0F, static_cast<float>(properties.stiffness) / largest);
    voxels_[e] = share[e] * largest;
  }
  for (std::size_t c = 0; c < points_.size(); ++c)
    for (std::size_t p = 0; p < points_[c].size(); ++p)
      points_[c][p] *= share[model.contacts[c].binding.voxel[p]];
}

void ContactStiffness::add_forces(const Model& model, const std::vector<std::array<double, 3>>& displacements,
                                  std::vector<std::array<double, 3>>& forces) const
{
  for (std::size_t c = 0; c < points_.size(); ++c)
    for (std::size_t p = 0; p < points_[c].size(); ++p)
    {
      const Binding& binding = model.contacts[c].binding;
      const auto& at = binding.coordinates[p];
      const auto& nodes = model.voxel_nodes[binding.voxel[p]];
      double weight[8];
      physics::trilinear_weights<double>(at[0], at[1], at[2], weight);
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        double moved = 0;
        for (std::size_t b = 0; b < 8; ++b)
          moved += weight[b] * displacements[nodes[b]][axis];
        for (std::size_t b = 0; b < 8; ++b)
          forces[nodes[b]][axis] += double(points_[c][p]) * weight[b] * moved;
      }
    }
}

}  // namespace frontalis
