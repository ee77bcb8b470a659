#include "runner/bone_forces.hpp"

#include "frontalis/model/sample_field.hpp"
#include "frontalis/physics/sliding.hpp"

namespace frontalis
{

BoneForces::BoneForces(Solver& solver, const Model& of)
    : model(of), effects(solver.effects()), pose(solver.controls().bone), sum(of.bones.size())
{
  solver.internal_forces(internal_);
  solver.displacements(displaced_);
}

void BoneForces::add(std::int32_t bone, const Vector& force, const Vector& moment)
{
  if (bone < 0)
    return;
  Reaction& to = sum[static_cast<std::size_t>(bone)];
  to.force = array_of(vector_of(to.force) + force);
  to.moment = array_of(vector_of(to.moment) + moment);
}

void BoneForces::add_at(std::int32_t bone, const Vector& at, const Vector& force)
{
  add(bone, force, cross(at - vector_of(pose_of(bone).translation), force));
}

RigidTransform BoneForces::pose_of(std::int32_t bone) const
{
  return bone < 0 ? RigidTransform() : pose[static_cast<std::size_t>(bone)];
}

BoneForces::Vector BoneForces::place_of(std::int32_t node) const
{
  return vector_of(rest_of(node)) + vector_of(displaced_[static_cast<std::size_t>(node)]);
}

BoneForces::Vector BoneForces::force_of(std::int32_t node) const
{
  return -1.0 * vector_of(internal_[static_cast<std::size_t>(node)]);
}

BoneForces::Vector BoneForces::normal_at(const ConstraintSurface& surface, const Vector& at) const
{
  const RigidTransform moved = pose_of(surface.bone);
  const physics::DistanceField field = view(surface.field);
  physics::FieldValue<double> value{};
  physics::LevelPlane<double> plane{};
  const Vector rest = vector_of(inverse(moved)(array_of(at)));
  if (!sample(field, physics::field_point(field, rest), value) || !level_plane(value, 0.0, plane))
    return { 0, 0, 0 };
  return vector_of(moved.turned(array_of(plane.normal)));
}

}  // namespace frontalis
