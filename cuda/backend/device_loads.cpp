#include "cuda/backend/device_loads.hpp"

#include "frontalis/physics/trilinear.hpp"
#include "solver/stepping/nodal_loads.hpp"

#include <algorithm>
#include <map>

namespace frontalis
{
namespace cuda
{

DeviceLoads::DeviceLoads(const Model& model, const Discretisation& discretisation,
                         const std::vector<std::uint32_t>& device_node)
    : model_(model)
{
  std::vector<double> relief;
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

  PartsByNode by_node(nodes_.size());
  for (std::size_t l = 0; l < model.loads.size(); ++l)
    if (model.loads[l].kind == Load::Kind::traction)
      add_traction(l, by_node);
  add_pressures(device_node, by_node);
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
  surface_force_ = DeviceArray<double>(surface_forces());
  if (pressure_.size() > 0)
    node_force_ = DeviceArray<double>(3 * nodes_.size());
}

std::vector<LoadPart>& DeviceLoads::of_node(std::int32_t node, PartsByNode& parts) const
{
  return parts[std::lower_bound(nodes_.begin(), nodes_.end(), node) - nodes_.begin()];
}

void DeviceLoads::add_traction(std::size_t index, PartsByNode& parts)
{
  const Load& load = model_.loads[index];
  const std::vector<double> area = vertex_areas(load.mesh);
  for (std::size_t v = 0; v < area.size(); ++v)
  {
    const auto& at = load.binding.coordinates[v];
    float weight[8];
    physics::trilinear_weights(at[0], at[1], at[2], weight);
    for (std::size_t b = 0; b < 8; ++b)
      of_node(model_.voxel_nodes[load.binding.voxel[v]][b], parts)
          .push_back({ static_cast<std::int32_t>(traction_.size() / 3), static_cast<std::int32_t>(index), weight[b] });
    for (const double component : load.value)
      traction_.push_back(area[v] * component);
  }
}

void DeviceLoads::add_pressures(const std::vector<std::uint32_t>& device_node, PartsByNode& parts)
{
  std::vector<std::array<double, 3>> rest;
  std::vector<std::array<std::int32_t, 3>> triangles;
  Binding binding;
  std::vector<double> pressure;
  for (std::size_t l = 0; l < model_.loads.size(); ++l)
  {
    const Load& load = model_.loads[l];
    if (load.kind != Load::Kind::pressure)
      continue;
    const auto first = static_cast<std::int32_t>(rest.size());
    for (const auto& triangle : load.mesh.triangles)
    {
      std::map<std::int32_t, float> weights;  // of the triangle's force, by node
      for (const auto v : triangle)
      {
        const auto& at = load.binding.coordinates[v];
        float weight[8];
        physics::trilinear_weights(at[0], at[1], at[2], weight);
        for (std::size_t b = 0; b < 8; ++b)
          weights[model_.voxel_nodes[load.binding.voxel[v]][b]] += weight[b];
      }
      const auto force = static_cast<std::int32_t>(traction_.size() / 3 + triangles.size());
      for (const auto& [node, weight] : weights)
        of_node(node, parts).push_back({ force, static_cast<std::int32_t>(l), weight });
      triangles.push_back({ first + triangle[0], first + triangle[1], first + triangle[2] });
      pressure.push_back(load.value[0]);
    }
    rest.insert(rest.end(), load.mesh.vertices.begin(), load.mesh.vertices.end());
    binding.voxel.insert(binding.voxel.end(), load.binding.voxel.begin(), load.binding.voxel.end());
    binding.coordinates.insert(binding.coordinates.end(), load.binding.coordinates.begin(),
                               load.binding.coordinates.end());
  }
  if (triangles.empty())
    return;
  pressed_ = DeviceSurface(model_, device_node, rest, binding, triangles);
  pressure_ = DeviceArray<double>(pressure);
}

// Those of pressures are found by update().
std::vector<double> DeviceLoads::surface_forces() const
{
  std::vector<double> forces(traction_.size() + 3 * pressure_.size(), 0);
  if (runs_)
    std::copy(traction_.begin(), traction_.end(), forces.begin());
  return forces;
}

void DeviceLoads::run(EffectSet running)
{
  runs_ = running.has(Effect::surface_loads);
  relieves_ = running.has(Effect::gravity);
  surface_force_.upload(surface_forces().data(), surface_force_.size());
}

void DeviceLoads::list_arrays(ArrayList& list)
{
  const Effect effect = surface_force_.size() > 0 ? Effect::surface_loads : Effect::gravity;
  list.add(effect, "parts of a surface's forces", begin_.bytes() + parts_.bytes() + growth_.bytes());
  list.add(effect, "forces", surface_force_.bytes() + node_force_.bytes());
  list.add(Effect::gravity, "weight that mass scaling added", relief_.bytes());
  list.add(effect, "surfaces", pressed_.bytes() + pressure_.bytes());
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
}

int DeviceLoads::end_of_launch(int step, int end) const
{
  return presses() ? std::min(end, step - step % steps_per_pressure + steps_per_pressure) : end;
}

void DeviceLoads::update(StepArguments& g, int step, const float4* u, cudaStream_t stream)
{
  if (!presses())
    return;
  g.load_force = node_force_.data();
  if (step % steps_per_pressure != 0)
    return;
  require(launch_pressure(pressed_.view(), pressure_.data(), u, surface_force_.data() + traction_.size(), stream),
          "forces of a pressure");
  require(launch_node_loads(g, static_cast<std::uint32_t>(nodes_.size()), step, node_force_.data(), stream),
          "forces of loads");
}

}  // namespace cuda
}  // namespace frontalis
