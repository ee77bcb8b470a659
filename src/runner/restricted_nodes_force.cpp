#include "runner/bone_forces.hpp"

namespace frontalis
{

BoneForces::Vector carried(const BoneForces::Vector& normal, double friction, const BoneForces::Vector& force)
{
  if (dot(normal, normal) == 0)
    return force;
  const BoneForces::Vector pressing = dot(normal, force) * normal, dragging = force - pressing;
  const double drag = norm(dragging), held = friction * norm(pressing);
  return pressing + (drag > held ? held / drag : 1) * dragging;
}

void add_sliding_nodes(BoneForces& bones)
{
  if (!bones.effects.has(Effect::sliding))
    return;
  const bool rubs = bones.effects.has(Effect::friction);
  for (const SlidingNode& node : bones.model.sliding)
  {
    const ConstraintSurface& surface = bones.model.constraint_surfaces[static_cast<std::size_t>(node.surface)];
    if (surface.bone < 0)
      continue;
    const BoneForces::Vector at = bones.place_of(node.node), normal = bones.normal_at(surface, at);
    bones.add_at(surface.bone, at, carried(normal, rubs ? surface.friction : 0, bones.force_of(node.node)));
  }
}

}  // namespace frontalis
