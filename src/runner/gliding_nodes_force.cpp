#include "runner/bone_forces.hpp"

namespace frontalis
{
namespace
{

using Vector = BoneForces::Vector;

/// The part of a force on a node that the surface carries: the whole component along the normal, and as much of the
/// tangential component as friction can hold. Where there is no normal, the surface carries the whole force, as it
/// would in equilibrium.
Vector carried(const Vector& normal, double friction, const Vector& force)
{
  if (dot(normal, normal) == 0)
    return force;
  const Vector pressing = dot(normal, force) * normal, dragging = force - pressing;
  const double drag = norm(dragging), held = friction * norm(pressing);
  return pressing + (drag > held ? held / drag : 1) * dragging;
}

}  // namespace

void add_gliding_nodes(BoneForces& bones)
{
  if (!bones.effects.has(Effect::sliding))
    return;
  const bool rubs = bones.effects.has(Effect::friction);
  for (const SlidingNode& node : bones.model.sliding)
  {
    const ConstraintSurface& surface = bones.model.constraint_surfaces[static_cast<std::size_t>(node.surface)];
    if (surface.bone < 0)
      continue;
    const Vector at = bones.place_of(node.node);
    const Vector normal = bones.normal_at(surface, at);
    bones.add_at(surface.bone, at, carried(normal, rubs ? surface.friction : 0, bones.force_of(node.node)));
  }
}

}  // namespace frontalis
