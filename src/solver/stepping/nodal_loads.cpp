#include "solver/stepping/nodal_loads.hpp"

#include "solver/skin/bound_points.hpp"

#include "frontalis/physics/trilinear.hpp"
#include "frontalis/solver/rigid_motion.hpp"

#include <algorithm>

namespace frontalis
{
namespace
{

using Vector = physics::Vec3<double>;

// Forces on the vertices of a loaded surface. Each corner takes a third of its triangle's force, which is the area
// vector times the pressure, or the area times the traction.
void vertex_forces(const Load& load, double share, const std::vector<std::array<double, 3>>& vertices,
                   std::vector<std::array<double, 3>>& forces)
{
  std::fill(forces.begin(), forces.end(), std::array<double, 3>{ { 0, 0, 0 } });
  for (const auto& t : load.mesh.triangles)
  {
    const Vector a = vector_of(vertices[t[0]]);
    const Vector area = 0.5 * cross(vector_of(vertices[t[1]]) - a, vector_of(vertices[t[2]]) - a);
    const Vector force = load.kind == Load::Kind::pressure ? (-share * load.value[0] / 3) * area
                                                           : (share * norm(area) / 3) * vector_of(load.value);
    for (const auto corner : t)
    {
      forces[corner][0] += force.x;
      forces[corner][1] += force.y;
      forces[corner][2] += force.z;
    }
  }
}

}  // namespace

// Part of a node's mass that gravity acts on: all of it, or with uniform scaling the inverse of the factor.
double weighed_share(const Model& model)
{
  const MassScalingSettings& scaling = model.mass_scaling;
  return scaling.kind == MassScalingSettings::Kind::uniform ? 1 / scaling.factor : 1;
}

std::vector<std::int32_t> relieved_nodes(const Model& model, const Discretisation& discretisation)
{
  std::vector<std::int32_t> nodes;
  const auto& g = model.gravity;
  const double all = weighed_share(model) * (1 - 1e-6);
  if (model.mass_scaling.kind != MassScalingSettings::Kind::none && (g[0] != 0 || g[1] != 0 || g[2] != 0))
    for (std::size_t n = 0; n < discretisation.weight_share.size(); ++n)
      if (double(discretisation.weight_share[n]) < all)
        nodes.push_back(static_cast<std::int32_t>(n));
  return nodes;
}

std::array<double, 3> gravity_relief(const Model& model, const Discretisation& discretisation, std::int32_t node)
{
  const double excess =
      discretisation.node_mass[node] * (double(discretisation.weight_share[node]) - weighed_share(model));
  return { { excess * model.gravity[0], excess * model.gravity[1], excess * model.gravity[2] } };
}

template <class Real>
NodalLoads<Real>::NodalLoads(const Model& model, const Discretisation& discretisation) : model_(model)
{
  nodes_ = relieved_nodes(model, discretisation);
  const bool relieved = !nodes_.empty();
  for (const auto& load : model.loads)
  {
    if (load.kind == Load::Kind::displacement)
      continue;
    for (const auto voxel : load.binding.voxel)
      nodes_.insert(nodes_.end(), model.voxel_nodes[voxel].begin(), model.voxel_nodes[voxel].end());
  }
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
  surface_forces_.assign(nodes_.size(), { { 0, 0, 0 } });
  forces_ = surface_forces_;
  for (const auto n : nodes_)
    if (relieved)
      relief_.push_back(gravity_relief(model, discretisation, n));
  for (const auto& load : model.loads)
  {
    if (load.kind == Load::Kind::displacement)
      continue;
    presses_ = presses_ || load.kind == Load::Kind::pressure;
    std::vector<std::vector<Contribution>> by_node(nodes_.size());
    for (std::size_t vertex = 0; vertex < load.binding.voxel.size(); ++vertex)
    {
      const auto& c = load.binding.coordinates[vertex];
      float weight[8];
      physics::trilinear_weights(c[0], c[1], c[2], weight);
      for (int b = 0; b < 8; ++b)
      {
        const auto node = model.voxel_nodes[load.binding.voxel[vertex]][b];
        const auto rank = std::lower_bound(nodes_.begin(), nodes_.end(), node) - nodes_.begin();
        by_node[rank].push_back({ static_cast<std::int32_t>(vertex), weight[b] });
      }
    }
    Surface surface{ &load, { 0 }, {}, {}, load.mesh.vertices };
    for (const auto& contributions : by_node)
    {
      surface.contributions.insert(surface.contributions.end(), contributions.begin(), contributions.end());
      surface.begin.push_back(static_cast<std::int32_t>(surface.contributions.size()));
    }
    surface.vertex_force.resize(load.mesh.vertices.size());
    surfaces_.push_back(std::move(surface));
  }
}

template <class Real>
void NodalLoads<Real>::run(EffectSet running)
{
  runs_ = running.has(Effect::surface_loads);
  relieves_ = running.has(Effect::gravity);
  for (auto* forces : { &surface_forces_, &forces_ })
    std::fill(forces->begin(), forces->end(), std::array<double, 3>{});
}

template <class Real>
void NodalLoads<Real>::list_arrays(ArrayList& list)
{
  const Effect effect = surfaces_.empty() ? Effect::gravity : Effect::surface_loads;
  list.add(effect, "loaded nodes", nodes_);
  list.add(effect, "nodal forces", surface_forces_);
  list.add(effect, "nodal forces", forces_);
  list.add(Effect::gravity, "weight that mass scaling added", relief_);
  for (const Surface& surface : surfaces_)
  {
    list.add(effect, "parts of a surface's forces", surface.begin);
    list.add(effect, "parts of a surface's forces", surface.contributions);
    list.add(effect, "forces at vertices", surface.vertex_force);
    list.add(effect, "forces at vertices", surface.vertices);
  }
}

template <class Real>
void NodalLoads<Real>::update(double time, const std::vector<float>& activation, const Real* const u[3])
{
  std::fill(surface_forces_.begin(), surface_forces_.end(), std::array<double, 3>{ { 0, 0, 0 } });
  for (auto& surface : surfaces_)
  {
    const Load& load = *surface.load;
    const double share = acting_share(load, time, activation);
    if (!runs_ || share == 0)
      continue;
    if (load.kind == Load::Kind::pressure)
      for (std::size_t vertex = 0; vertex < surface.vertices.size(); ++vertex)
      {
        const auto moved = bound_displacement(model_, load.binding, vertex, u);
        for (int axis = 0; axis < 3; ++axis)
          surface.vertices[vertex][axis] = load.mesh.vertices[vertex][axis] + moved[axis];
      }
    vertex_forces(load, share, surface.vertices, surface.vertex_force);
    for (std::size_t rank = 0; rank < nodes_.size(); ++rank)
      for (auto c = surface.begin[rank]; c < surface.begin[rank + 1]; ++c)
        for (int axis = 0; axis < 3; ++axis)
          surface_forces_[rank][axis] +=
              double(surface.contributions[c].weight) * surface.vertex_force[surface.contributions[c].vertex][axis];
  }
  forces_ = surface_forces_;
  for (std::size_t rank = 0; relieves_ && rank < relief_.size(); ++rank)
    for (int axis = 0; axis < 3; ++axis)
      forces_[rank][axis] += relief_[rank][axis];
}

template <class Real>
template <class Visit>
void NodalLoads<Real>::each(const NodeShare& share, const Visit& visit) const
{
  const auto first = std::lower_bound(nodes_.begin(), nodes_.end(), share.first_node) - nodes_.begin();
  for (auto l = static_cast<std::size_t>(first); l < nodes_.size() && nodes_[l] < share.end_node; ++l)
    visit(l);
}

template <class Real>
void NodalLoads<Real>::add_forces(const NodeShare& share, const ForceSink<Real>& sink)
{
  each(share, [&](std::size_t l) { sink(nodes_[l], forces_[l]); });
}

template <class Real>
void NodalLoads<Real>::account(const NodeShare& share, EnergyAccount<Real>& account, const Real* const v[3],
                               double kick)
{
  each(share, [&](std::size_t l) { account.load(model_.nodes[nodes_[l]][2], nodes_[l], surface_forces_[l], v, kick); });
}

template class NodalLoads<float>;
template class NodalLoads<double>;

}  // namespace frontalis
