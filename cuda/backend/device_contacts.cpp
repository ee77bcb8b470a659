#include "cuda/backend/device_model.hpp"

#include <algorithm>
#include <cstring>

namespace frontalis
{
namespace cuda
{

DeviceContacts::DeviceContacts(const Model& model, const std::vector<std::uint32_t>& device_node)
{
  std::vector<physics::DistanceField> fields;
  for (const ConstraintSurface& surface : model.constraint_surfaces)
    fields.push_back(surfaces_.add(surface.field));
  fields_ = DeviceArray<physics::DistanceField>(fields);
  const auto surface_of = [&model](const SlidingNode& node) -> const ConstraintSurface&
  { return model.constraint_surfaces[node.surface]; };
  // Order: nodes with friction first, and within both groups the order in which warps process the nodes.
  std::vector<SlidingNode> nodes = model.sliding;
  std::sort(nodes.begin(), nodes.end(),
            [&](const SlidingNode& a, const SlidingNode& b)
            {
              const bool rubs = surface_of(a).friction > 0;
              return rubs != (surface_of(b).friction > 0) ? rubs : device_node[a.node] < device_node[b.node];
            });
  const std::size_t count = nodes.size();
  std::vector<SlidingNodeField> sliding;
  std::vector<float4> at, samples(sample_words * count, float4{ 0, 0, 0, 0 });
  std::vector<float> friction;
  std::vector<float4> bone;
  float none = 0;
  std::memcpy(&none, &no_cell, sizeof none);
  for (const SlidingNode& node : nodes)
  {
    const ConstraintSurface& surface = surface_of(node);
    const auto rest = rest_position(model, node.node);
    const auto point = physics::field_point(view(surface.field), { rest[0], rest[1], rest[2] });
    const std::size_t index = sliding.size();
    if (surface.field.radius > 0)
      samples[index].x = static_cast<float>(norm(point.offset) - surface.field.radius - node.distance);
    else
      samples[(sample_words - 1) * count + index].w = static_cast<float>(1 / surface.field.spacing);
    at.push_back({ static_cast<float>(point.offset.x), static_cast<float>(point.offset.y),
                   static_cast<float>(point.offset.z), none });
    sliding.push_back(
        { node.surface, { point.cell[0], point.cell[1], point.cell[2] }, static_cast<float>(node.distance) });
    if (surface.friction > 0)
      friction.push_back(static_cast<float>(surface.friction));
    node_.push_back(node.node);
    bone.push_back({ static_cast<float>(rest[0]), static_cast<float>(rest[1]), static_cast<float>(rest[2]), 0 });
    std::memcpy(&bone.back().w, &surface.bone, sizeof surface.bone);
    glides_.push_back(surface.bone >= 0);
  }
  sliding_ = DeviceArray<SlidingNodeField>(sliding);
  at_ = DeviceArray<float4>(at);
  samples_ = DeviceArray<float4>(samples);
  planes_ = DeviceArray<float4>(count);
  friction_ = DeviceArray<float>(friction);
  pressing_ = DeviceArray<float>(friction.size());
  if (std::find(glides_.begin(), glides_.end(), true) != glides_.end())
    gliding_ = DeviceArray<float4>(bone);
  reset();
}

void DeviceContacts::add_tasks(std::vector<NodeTask>& task_of) const
{
  for (std::size_t index = 0; index < node_.size(); ++index)
    task_of[node_[index]].of[glides_[index] ? node_gliding : node_sliding] = static_cast<std::int32_t>(index);
}

void DeviceContacts::describe(StepArguments& g) const
{
  g.fields = fields_.data();
  g.sliding = sliding_.data();
  g.sliding_count = static_cast<std::uint32_t>(sliding_.size());
  g.sliding_at = at_.data();
  g.samples = samples_.data();
  g.planes = planes_.data();
  g.friction = friction_.data();
  g.pressing = pressing_.data();
  g.rubbing_count = rubs_ ? static_cast<std::uint32_t>(friction_.size()) : 0;
  g.gliding = gliding_.data();
}

void DeviceContacts::list_arrays(ArrayList& list)
{
  surfaces_.list_arrays(Effect::sliding, list);
  list.add(Effect::sliding, "fields of surfaces", fields_.bytes());
  list.add(Effect::sliding, "samples at nodes", sliding_.bytes() + at_.bytes() + samples_.bytes() + gliding_.bytes());
  list_state(list, Effect::sliding, "tangent planes", planes_);
  list.add(Effect::friction, "nodes that rub", friction_.bytes());
  list_state(list, Effect::friction, "nodes that rub", pressing_);
}

void DeviceContacts::run(EffectSet running)
{
  rubs_ = running.has(Effect::sliding) && running.has(Effect::friction);
  if (!running.has(Effect::sliding))
    planes_.clear();
  if (!rubs_)
    pressing_.clear();
}

void DeviceContacts::reset()
{
  planes_.clear();
  pressing_.clear();
}

}  // namespace cuda
}  // namespace frontalis
