#include "solver/contact/contact_stiffness.hpp"

#include "frontalis/physics/contact.hpp"
#include "frontalis/physics/hourglass.hpp"
#include "solver/contact/pushed_contact.hpp"
#include "solver/stepping/bound_stiffness.hpp"
#include "solver/stepping/discretisation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace frontalis
{
namespace
{

// Contact may be up to `stiffest_factor` times as stiff as its law says where this does not shorten the time step,
// because thin tissue on bone resists a finger several times as much as its Young's modulus suggests. The squared
// frequencies of the nodes in contact stay below `share_of_largest` of the model's largest, by the measure by which
// steps are chosen: the bound at nodes or, for assembled steps, `wave_stiffness`.
constexpr double stiffest_factor = 10;
constexpr double share_of_largest = 0.95;

// Upper limit of the stiffness of contact at a node, divided by the stiffness on a flat side of whole voxels with as
// much tissue. The limit is needed because points far outside of their voxel have large weights, and because many
// points may be bound to a voxel with little tissue.
constexpr double stiffest_node = 2;

double shear_modulus(const VoxelProperties& voxel)
{
  double shear = voxel.mu;
  for (const LawPart& part : voxel.laws)
    shear += part.weight * part.stiffness_at_rest;
  return shear;
}

double young_modulus(const VoxelProperties& voxel) { return physics::young_modulus(shear_modulus(voxel), voxel.kappa); }

// Stiffness [N/m] of a voxel in a plane wave along its shortest edge, without muscles and contact. In assembled voxels
// a squared frequency is about the sum of these figures at a node, divided by the node's mass. The bound at nodes, in
// contrast, counts what a voxel resists to a change of volume three times, and every muscle at full activation.
double wave_stiffness(const VoxelProperties& voxel, double shortest_edge)
{
  const double modulus = voxel.kappa + 4.0 / 3 * shear_modulus(voxel);
  return 0.5 * modulus * voxel.tissue_volume / (shortest_edge * shortest_edge);
}

}  // namespace

ContactStiffness::ContactStiffness(const Model& model, const Discretisation& discretisation)
    : bodies_(model.contacts.size())
{
  const double edge = *std::min_element(model.spacing.begin(), model.spacing.end());
  // For each node: the bound of the stiffness of its voxels, and the stiffness of contact if the node were on a flat
  // side of whole voxels, where each of four voxels contributes a quarter of the area edge^2.
  std::vector<double> of_voxels(model.nodes.size(), 0), of_flat_side(model.nodes.size(), 0);
  std::vector<double> per_area(model.voxels.size());
  voxels_.resize(model.voxels.size());
  VoxelProperties properties;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    discretisation.voxel(e, properties);
    per_area[e] = physics::contact_stiffness * young_modulus(properties) / edge;
    voxels_[e] = static_cast<float>(properties.stiffness);
    for (const auto node : model.voxel_nodes[e])
    {
      of_voxels[node] += properties.stiffness;
      of_flat_side[node] += per_area[e] * properties.tissue_volume / (4 * edge);
    }
  }
  for (const Contact& contact : model.contacts)
  {
    add(contact.binding, contact.area, per_area, counted(contact));
    const bool pushed = contact.mass > 0;
    supplies_.push_back({ contact.bone, &contact.binding, pushed ? contact.spring : 0,
                          pushed ? norm(vector_of(contact.force)) / std::sqrt(2 * contact.mass) : 0 });
  }
  for (const SelfContact& contact : model.self_contacts)
    add(contact.binding, vertex_areas(contact.surface), per_area, 2);
  const std::vector<double> asked = rows(model, true);
  for (Surface& surface : surfaces_)
    for (std::size_t p = 0; p < surface.points.size(); ++p)
    {
      double share = 1;
      for (const auto node : model.voxel_nodes[surface.binding->voxel[p]])
        if (asked[node] > stiffest_node * of_flat_side[node])
          share = std::min(share, stiffest_node * of_flat_side[node] / asked[node]);
      surface.points[p] = static_cast<float>(share * double(surface.points[p]));
    }
  share_out(model, of_voxels);
}

// Distributes the stiffness that contact adds to nodes among their voxels. At first voxels_ holds the voxels' own
// bounds.
void ContactStiffness::share_out(const Model& model, const std::vector<double>& of_voxels)
{
  share_rows(model, rows(model, false), of_voxels, voxels_);
  for (std::size_t c = 0; c < bodies_; ++c)
    if (model.contacts[c].mass > 0)
    {
      const auto& points = surfaces_[c].points;
      longest_step_ = std::min(
          longest_step_, longest_pushed_step(model.contacts[c], std::accumulate(points.begin(), points.end(), 0.0)));
    }
}

void ContactStiffness::stiffen(const Model& model, const Discretisation& discretisation)
{
  if (bodies_ == 0)
    return;
  // For each node: `of_voxels`, the bound of its stiffness without contact; `resists`, the measure of this stiffness by
  // which steps are chosen; `squared`, the measure of its squared frequency with contact, 0 for held nodes.
  const bool assembled = model.time_step_estimate == TimeStepEstimate::assembled;
  const double edge = *std::min_element(model.spacing.begin(), model.spacing.end());
  std::vector<double> of_voxels(model.nodes.size(), 0), resists(of_voxels), squared(of_voxels);
  VoxelProperties properties;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    discretisation.voxel(e, properties);
    const double own = properties.stiffness - in_voxel(e);
    const double measure = assembled ? wave_stiffness(properties, edge) : own;
    for (const auto node : model.voxel_nodes[e])
    {
      of_voxels[node] += own;
      resists[node] += measure;
      squared[node] += (measure + in_voxel(e)) / discretisation.node_mass[node];
    }
    voxels_[e] = static_cast<float>(own);
  }
  for (const auto node : discretisation.held)
    squared[node] = 0;
  const double limit = share_of_largest * *std::max_element(squared.begin(), squared.end());
  // The measure at a node may grow by the smallest factor that all nodes of its voxels and of their neighbours allow.
  // Then no node's measure is too large.
  std::vector<double> growth(model.nodes.size(), std::numeric_limits<double>::max());
  for (const auto& nodes : model.voxel_nodes)
  {
    double largest = 0;
    for (const auto node : nodes)
      largest = std::max(largest, squared[node]);
    for (const auto node : nodes)
      growth[node] = std::min(growth[node], std::max(1.0, limit / largest));
  }
  const std::vector<double> added = rows(model, false);
  for (std::size_t c = 0; c < bodies_; ++c)
    for (std::size_t p = 0; p < surfaces_[c].points.size(); ++p)
    {
      double factor = stiffest_factor;
      for (const auto node : model.voxel_nodes[surfaces_[c].binding->voxel[p]])
        factor = std::min(factor, 1 + (growth[node] - 1) * resists[node] / added[node]);
      surfaces_[c].points[p] *= static_cast<float>(factor);
    }
  share_out(model, of_voxels);
}

void ContactStiffness::add(const Binding& binding, const std::vector<double>& area, const std::vector<double>& per_area,
                           double moves)
{
  Surface surface{ &binding, {}, moves };
  for (std::size_t p = 0; p < area.size(); ++p)
    surface.points.push_back(static_cast<float>(per_area[binding.voxel[p]] * area[p]));
  surfaces_.push_back(std::move(surface));
}

std::vector<double> ContactStiffness::rows(const Model& model, bool alone) const
{
  std::vector<double> rows(model.nodes.size(), 0);
  for (const Surface& surface : surfaces_)
    add_stiffness_rows(model, *surface.binding, surface.points, alone ? 1 : surface.moves, rows);
  return rows;
}

std::vector<PointStiffness> ContactStiffness::matrices() const
{
  std::vector<PointStiffness> matrices;
  for (const Surface& surface : surfaces_)
  {
    matrices.push_back({ surface.binding, {} });
    for (std::int32_t p = 0; p < static_cast<std::int32_t>(surface.points.size()); ++p)
      matrices.back().entries.push_back({ p, p, surface.moves * double(surface.points[p]) });
  }
  return matrices;
}

}  // namespace frontalis
