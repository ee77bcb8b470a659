#include "cuda/backend/device_surface.hpp"

#include "frontalis/physics/trilinear.hpp"
#include "solver/stepping/nodal_loads.hpp"

#include <algorithm>

namespace frontalis
{
namespace cuda
{

DeviceSurface::DeviceSurface(const Model& model, const std::vector<std::uint32_t>& device_node,
                             const std::vector<std::array<double, 3>>& rest, const Binding& binding,
                             const std::vector<std::array<std::int32_t, 3>>& triangles)
    : vertices_(rest.size())
{
  std::vector<std::uint32_t> nodes;
  std::vector<float> coordinates;
  std::vector<double> positions;
  for (std::size_t v = 0; v < rest.size(); ++v)
  {
    for (const auto node : model.voxel_nodes[binding.voxel[v]])
      nodes.push_back(device_node[node]);
    coordinates.insert(coordinates.end(), binding.coordinates[v].begin(), binding.coordinates[v].end());
    positions.insert(positions.end(), rest[v].begin(), rest[v].end());
  }
  std::vector<int3> corners;
  std::vector<std::int32_t> begin(rest.size() + 1, 0);
  for (const auto& t : triangles)
  {
    corners.push_back(int3{ t[0], t[1], t[2] });
    for (const auto corner : t)
      ++begin[corner + 1];
  }
  for (std::size_t v = 0; v < rest.size(); ++v)
    begin[v + 1] += begin[v];
  std::vector<std::int32_t> around(3 * triangles.size()), next(begin.begin(), begin.end() - 1);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (const auto corner : triangles[t])
      around[next[corner]++] = static_cast<std::int32_t>(t);
  nodes_ = DeviceArray<std::uint32_t>(nodes);
  coordinates_ = DeviceArray<float>(coordinates);
  rest_ = DeviceArray<double>(positions);
  triangles_ = DeviceArray<int3>(corners);
  around_begin_ = DeviceArray<std::int32_t>(begin);
  around_ = DeviceArray<std::int32_t>(around);
}

BoundSurface DeviceSurface::view() const
{
  return { static_cast<std::uint32_t>(vertices_),
           nodes_.data(),
           coordinates_.data(),
           rest_.data(),
           triangles_.data(),
           around_begin_.data(),
           around_.data() };
}

std::size_t DeviceSurface::bytes() const
{
  return nodes_.bytes() + coordinates_.bytes() + rest_.bytes() + triangles_.bytes() + around_begin_.bytes() +
         around_.bytes();
}

DeviceLoads::DeviceLoads(const Model& model, const Discretisation& discretisation,
                         const std::vector<std::uint32_t>& device_node)
    : model_(model)
{
  std::vector<double> force, relief;
  std::vector<LoadGrowth> growth;
  nodes_ = relieved_nodes(model, discretisation);
  const bool relieved = !nodes_.empty();
  for (const auto& load : model.loads)
  {
    growth.push_back({ load.ramp, load.activation });
    if (load.kind == Load::Kind::displacement)
      continue;
    for (const auto voxel : load.binding.voxel)
      nodes_.insert(nodes_.end(), model.voxel_nodes[voxel].begin(), model.voxel_nodes[voxel].end());
  }
  if (!nodes_.empty())
    growth_ = DeviceArray<LoadGrowth>(growth);
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());

  for (const auto n : nodes_)
    if (relieved)
      for (const double x : gravity_relief(model, discretisation, n))
        relief.push_back(x);
  relief_ = DeviceArray<double>(relief);

  std::vector<std::vector<LoadPart>> by_node(nodes_.size());
  for (std::size_t l = 0; l < model.loads.size(); ++l)
  {
    const Load& load = model.loads[l];
    if (load.kind == Load::Kind::displacement)
      continue;
    const std::size_t first = force.size() / 3;
    force.resize(force.size() + 3 * load.mesh.vertices.size(), 0);
    if (load.kind == Load::Kind::pressure)
      pressures_.push_back({ DeviceSurface(model, device_node, load.mesh.vertices, load.binding, load.mesh.triangles),
                             &load, first, false });
    else
    {
      const std::vector<double> area = vertex_areas(load.mesh);
      for (std::size_t v = 0; v < area.size(); ++v)
        for (std::size_t axis = 0; axis < 3; ++axis)
          force[3 * (first + v) + axis] = area[v] * load.value[axis];
    }
    for (std::size_t v = 0; v < load.binding.voxel.size(); ++v)
    {
      const auto& c = load.binding.coordinates[v];
      float weight[8];
      physics::trilinear_weights(c[0], c[1], c[2], weight);
      for (int b = 0; b < 8; ++b)
      {
        const auto node = model.voxel_nodes[load.binding.voxel[v]][b];
        const auto rank = std::lower_bound(nodes_.begin(), nodes_.end(), node) - nodes_.begin();
        by_node[rank].push_back({ static_cast<std::int32_t>(first + v), static_cast<std::int32_t>(l), weight[b] });
      }
    }
  }
  std::vector<std::int32_t> begin(1, 0);
  std::vector<LoadPart> parts;
  for (const auto& here : by_node)
  {
    parts.insert(parts.end(), here.begin(), here.end());
    begin.push_back(static_cast<std::int32_t>(parts.size()));
  }
  if (!nodes_.empty())
    begin_ = DeviceArray<std::int32_t>(begin);
  parts_ = DeviceArray<LoadPart>(parts);
  vertex_force_ = DeviceArray<double>(force);
  traction_ = std::move(force);
  if (!pressures_.empty())
  {
    vertex_position_ = DeviceArray<double>(traction_.size());
    node_force_ = DeviceArray<double>(3 * nodes_.size());
  }
}

void DeviceLoads::run(EffectSet running)
{
  runs_ = running.has(Effect::surface_loads);
  relieves_ = running.has(Effect::gravity);
  const std::vector<double> none(traction_.size(), 0);
  vertex_force_.upload((runs_ ? traction_ : none).data(), traction_.size());
}

void DeviceLoads::list_arrays(ArrayList& list)
{
  const Effect effect = vertex_force_.size() > 0 ? Effect::surface_loads : Effect::gravity;
  list.add(effect, "parts of a surface's forces", begin_.bytes() + parts_.bytes() + growth_.bytes());
  list.add(effect, "forces at vertices", vertex_force_.bytes() + vertex_position_.bytes() + node_force_.bytes());
  list.add(Effect::gravity, "weight that mass scaling added", relief_.bytes());
  for (const Pressure& pressure : pressures_)
    list.add(effect, "surfaces", pressure.surface.bytes());
}

bool DeviceLoads::acts(const Load& load, const StepPlan& plan) const
{
  if (!runs_ || load.kind == Load::Kind::displacement)
    return false;
  const auto a = static_cast<std::size_t>(std::max(load.activation, 0));
  return load.activation < 0 || plan.begin.activation[a] != 0 || plan.end.activation[a] != 0;
}

void DeviceLoads::begin(const StepPlan& plan)
{
  acts_ = std::any_of(model_.loads.begin(), model_.loads.end(), [&](const Load& load) { return acts(load, plan); });
  follows_ = false;
  for (Pressure& pressure : pressures_)
  {
    pressure.acts = acts(*pressure.load, plan);
    follows_ = follows_ || pressure.acts;
  }
}

void DeviceLoads::update(StepArguments& g, int step, const float4* u, cudaStream_t stream)
{
  if (!follows_)
    return;
  for (const auto& p : pressures_)
    if (p.acts)
      require(launch_pressure(p.surface.view(), u, p.load->value[0], vertex_position_.data() + 3 * p.first_vertex,
                              vertex_force_.data() + 3 * p.first_vertex, stream),
              "forces of a pressure");
  g.load_force = node_force_.data();
  require(launch_node_loads(g, static_cast<std::uint32_t>(nodes_.size()), step, node_force_.data(), stream),
          "forces of loads");
}

}  // namespace cuda
}  // namespace frontalis
