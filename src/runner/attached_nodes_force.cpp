#include "runner/bone_forces.hpp"

namespace frontalis
{

// An attached node moves by the share `ratio` of its master's motion relative to the bone. By the principle of virtual
// work, the master feels that share of the force, and the bone feels the rest. Of a force on a node that slides on a
// surface, this is true of the part along the surface's normal.
void add_attached_nodes(BoneForces& bones)
{
  using Vector = BoneForces::Vector;
  for (const AttachedNode& node : bones.model.attached)
  {
    const Vector force = bones.force_of(node.node);
    if (node.surface < 0)
    {
      const auto carried_to = [&, pose = bones.pose_of(node.bone)](std::int32_t n) -> Vector
      {
        const auto place = pose(bones.rest_of(n));
        return { place[0], place[1], place[2] };
      };
      bones.add_at(node.bone, carried_to(node.node), force);
      bones.add_at(node.bone, carried_to(node.master), -node.ratio * force);
      continue;
    }
    const ConstraintSurface& surface = bones.model.constraint_surfaces[static_cast<std::size_t>(node.surface)];
    if (surface.bone < 0)
      continue;
    const Vector at = bones.place_of(node.node), master = bones.place_of(node.master);
    const Vector normal = bones.normal_at(surface, at), of_master = bones.normal_at(surface, master);
    const Vector pressing = carried(normal, 0, force);
    bones.add_at(surface.bone, at, pressing);
    const double both = dot(normal, normal) * dot(of_master, of_master);
    bones.add_at(surface.bone, master, -node.ratio * (both > 0 ? dot(normal, force) * of_master : pressing));
  }
}

}  // namespace frontalis
