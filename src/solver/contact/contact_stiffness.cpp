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

// Limit of the stiffness of contact at a node, over that on a flat side of whole voxels with as much tissue. Points
// that lie far outside of their voxel have large weights, and many points may be bound to a voxel with little tissue.
constexpr double stiffest_node = 2;

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
  const double edge = *std::min_element(model.spacing.begin(), model.spacing.end());
  // Of each node: the bound of the stiffness of its voxels, and the stiffness of contact if it were on a flat side of
  // whole voxels, whose four at the node carry a quarter of an edge^2 each.
  std::vector<double> of_voxels(model.nodes.size(), 0), of_flat_side(model.nodes.size(), 0);
  std::vector<double> young(model.voxels.size());
  voxels_.resize(model.voxels.size());
  VoxelProperties properties;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    discretisation.voxel(e, properties);
    young[e] = young_modulus(properties);
    voxels_[e] = static_cast<float>(properties.stiffness);
    for (const auto node : model.voxel_nodes[e])
    {
      of_voxels[node] += properties.stiffness;
      of_flat_side[node] += physics::contact_stiffness * young[e] * properties.tissue_volume / (4 * edge * edge);
    }
  }
  for (const Contact& contact : model.contacts)
  {
    auto& points = points_.emplace_back();
    for (std::size_t p = 0; p < contact.points.size(); ++p)
      points.push_back(
          static_cast<float>(physics::contact_stiffness * young[contact.binding.voxel[p]] / edge * contact.area[p]));
  }
  const std::vector<double> asked = rows(model);
  for (std::size_t c = 0; c < points_.size(); ++c)
    for (std::size_t p = 0; p < points_[c].size(); ++p)
      for (const auto node : model.voxel_nodes[model.contacts[c].binding.voxel[p]])
        if (asked[node] > stiffest_node * of_flat_side[node])
          points_[c][p] = std::min(
              points_[c][p], static_cast<float>(points_[c][p] * stiffest_node * of_flat_side[node] / asked[node]));
  // What contact adds to a node is shared by its voxels in proportion to their own bounds.
  const std::vector<double> added = rows(model);
  for (std::size_t e = 0; e < voxels_.size(); ++e)
  {
    double share = 0;
    for (const auto node : model.voxel_nodes[e])
      share = std::max(share, added[node] / of_voxels[node]);
    voxels_[e] *= static_cast<float>(share);
  }
}

// The stiffness of a point on the nodes of its voxel is k w w^T, w its weights. The rows of these matrices, added over
// all points, bound the eigenvalues of their sum divided by the masses (Gershgorin).
std::vector<double> ContactStiffness::rows(const Model& model) const
{
  std::vector<double> rows(model.nodes.size(), 0);
  for (std::size_t c = 0; c < points_.size(); ++c)
    for (std::size_t p = 0; p < points_[c].size(); ++p)
    {
      const Binding& binding = model.contacts[c].binding;
      const auto& at = binding.coordinates[p];
      double weight[8], sum = 0;
      physics::trilinear_weights<double>(at[0], at[1], at[2], weight);
      for (const double w : weight)
        sum += std::abs(w);
      for (std::size_t b = 0; b < 8; ++b)
        rows[model.voxel_nodes[binding.voxel[p]][b]] += double(points_[c][p]) * std::abs(weight[b]) * sum;
    }
  return rows;
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
