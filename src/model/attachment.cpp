#include "frontalis/model/model.hpp"

#include "model/effect_description.hpp"
#include "model/model_checks.hpp"
#include "model/model_layout.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

EffectPresence found(const Model& model)
{
  const std::size_t nodes = model.attached.size();
  return { nodes > 0, nodes > 0 ? "boundary: true" : "boundary: staircase", 0, nodes };
}

void check_joints(const Model& model)
{
  using namespace checks;
  const auto node = index_below(model.nodes.size());
  check_each("joints (node)", node, model.joints, &Model::Joint::node);
  check_each("joints (master)", node, model.joints, &Model::Joint::master);
  if (model.joints.empty())
    return;
  std::vector<bool> free(model.nodes.size(), true);
  for (const RigidNode& rigid : model.rigid)
    free[rigid.node] = false;
  for (const AttachedNode& attached : model.attached)
    free[attached.node] = false;
  for (std::size_t n = 0; n < model.joints.size(); ++n)
  {
    if (!free[model.joints[n].node])
      fail("joints", "entry {} is node {}, which another entry restricts", n, model.joints[n].node);
    free[model.joints[n].node] = false;
  }
  for (std::size_t n = 0; n < model.joints.size(); ++n)
  {
    const auto [joined, master] = model.joints[n];
    if (!free[master])
      fail("joints", "the master of entry {} is node {}, which is restricted itself", n, master);
    if (rest_place(model, model.nodes[joined]) != rest_place(model, model.nodes[master]))
      fail("joints", "the nodes {} and {} of entry {} rest at different places", joined, master, n);
  }
}

void check(const Model& model)
{
  using namespace checks;
  const auto node = index_below(model.nodes.size());
  check_each("attached (node)", node, model.attached, &AttachedNode::node);
  check_each("attached (master)", node, model.attached, &AttachedNode::master);
  check_each("attached (bone)", index_below(model.bones.size(), -1), model.attached, &AttachedNode::bone);
  check_each("attached (surface)", index_below(model.constraint_surfaces.size(), -1), model.attached,
             &AttachedNode::surface);
  check_each("attached (constraint)", index_below(model.constraints.size(), -1), model.attached,
             &AttachedNode::constraint);
  std::vector<bool> restricted(model.nodes.size(), false);
  for (const RigidNode& rigid : model.rigid)
    restricted[rigid.node] = true;
  for (const SlidingNode& sliding : model.sliding)
    restricted[sliding.node] = true;
  for (std::size_t n = 0; n < model.attached.size(); ++n)
  {
    const AttachedNode& attached = model.attached[n];
    if (restricted[attached.node])
      fail("attached (node)", "entry {} is node {}, which another entry restricts", n, attached.node);
    restricted[attached.node] = true;
    if (!(std::abs(attached.ratio) <= 1))
      fail("attached (ratio)", "entry {} is {}; ratios run from -1 to 1", n, attached.ratio);
  }
  for (std::size_t n = 0; n < model.attached.size(); ++n)
    if (restricted[model.attached[n].master])
      fail("attached (master)", "entry {} is node {}, which is restricted itself", n, model.attached[n].master);
  check_joints(model);
}

// Writes or reads the attached nodes of a model file. The file of a model without attached nodes has no arrays for
// them.
template <class Archive, class Nodes>
void exchange_nodes(Archive& archive, Nodes& nodes)
{
  if (!archive.group_if(!nodes.empty(), "attached"))
    return;
  archive.table("attached", nodes, Column{ "node", &AttachedNode::node }, Column{ "master", &AttachedNode::master },
                Column{ "ratio", &AttachedNode::ratio }, Column{ "bone", &AttachedNode::bone },
                Column{ "surface", &AttachedNode::surface }, Column{ "constraint", &AttachedNode::constraint });
}

void set_bones(const Model& model, std::vector<std::int32_t>& bone)
{
  for (const AttachedNode& node : model.attached)
    bone[node.node] = node.surface < 0 ? node.bone : model.constraint_surfaces[node.surface].bone;
}

}  // namespace

EffectDescription attachment_description()
{
  return { Effect::attachment,
           found,
           [](Model& model, EffectSet) { model.attached.clear(); },
           check,
           [](ModelWriter& archive, const Model& model) { exchange_nodes(archive, model.attached); },
           [](ModelReader& archive, Model& model) { exchange_nodes(archive, model.attached); },
           set_bones };
}

void remove_attached(Model& model, bool sliding)
{
  auto& nodes = model.attached;
  nodes.erase(std::remove_if(nodes.begin(), nodes.end(),
                             [=](const AttachedNode& node) { return (node.surface >= 0) == sliding; }),
              nodes.end());
}

}  // namespace frontalis
