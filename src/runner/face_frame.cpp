#include "frontalis/runner/face_frame.hpp"

#include "frontalis/model/effects.hpp"
#include "frontalis/model/sample_field.hpp"
#include "frontalis/physics/sliding.hpp"
#include "frontalis/runner/named_controls.hpp"
#include "frontalis/solver/rigid_motion.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

std::array<float, 3> rounded(const std::array<double, 3>& p)
{
  return { { static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]) } };
}

bool all_finite(const std::vector<std::array<float, 3>>& vectors)
{
  return std::all_of(vectors.begin(), vectors.end(),
                     [](const std::array<float, 3>& v)
                     { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); });
}

using Vector = physics::Vec3<double>;

Vector vector_of(const std::array<double, 3>& a) { return { a[0], a[1], a[2] }; }

std::array<double, 3> array_of(const Vector& v) { return { { v.x, v.y, v.z } }; }

/// Sums of forces on bones.
struct BoneForces
{
  const std::vector<RigidTransform>& pose;
  std::vector<Reaction> sum;

  /// Adds a force and its moment about the point of the bone that rests at the origin of the local frame. Forces on
  /// bone -1, which stands still, are left out.
  void add(std::int32_t bone, const Vector& force, const Vector& moment)
  {
    if (bone < 0)
      return;
    Reaction& to = sum[static_cast<std::size_t>(bone)];
    to.force = array_of(vector_of(to.force) + force);
    to.moment = array_of(vector_of(to.moment) + moment);
  }
  /// Adds a force that acts at a point [m].
  void add_at(std::int32_t bone, const Vector& at, const Vector& force)
  {
    if (bone >= 0)
      add(bone, force, cross(at - vector_of(pose[static_cast<std::size_t>(bone)].translation), force));
  }
  RigidTransform pose_of(std::int32_t bone) const
  {
    return bone < 0 ? RigidTransform() : pose[static_cast<std::size_t>(bone)];
  }
};

/// The normal of a moved surface at a point; zero where its field has no samples or too short a gradient.
Vector normal_at(const ConstraintSurface& surface, const RigidTransform& pose, const Vector& at)
{
  const physics::DistanceField field = view(surface.field);
  physics::FieldValue<double> value{};
  physics::LevelPlane<double> plane{};
  const Vector rest = vector_of(inverse(pose)(array_of(at)));
  if (!sample(field, physics::field_point(field, rest), value) || !level_plane(value, 0.0, plane))
    return { 0, 0, 0 };
  return vector_of(pose.turned(array_of(plane.normal)));
}

/// The part of a force on a sliding node that the surface carries: the whole component along the normal, and as much of
/// the tangential component as friction can hold. Where there is no normal, the surface carries the whole force, as it
/// would in equilibrium.
Vector carried(const Vector& normal, double friction, const Vector& force)
{
  if (dot(normal, normal) == 0)
    return force;
  const Vector pressing = dot(normal, force) * normal, dragging = force - pressing;
  const double drag = norm(dragging), held = friction * norm(pressing);
  return pressing + (drag > held ? held / drag : 1) * dragging;
}

BodyFrame in_face_frame(const Model& model, const Reaction& local, const RigidTransform& pose)
{
  const std::array<double, 3> origin = inverse(model.to_face).translation;
  // Moves the reference point of the moment from the origin of the local frame to that of the face frame. Both points
  // are fixed to the body.
  const Vector about_face = vector_of(local.moment) - cross(vector_of(pose.turned(origin)), vector_of(local.force));
  return { { model.to_face.turned(local.force), model.to_face.turned(array_of(about_face)) },
           motion_in_face(model, pose) };
}

}  // namespace

void to_face_frame(const Model& model, SkinState& skin)
{
  for (std::array<float, 3>& vertex : skin.vertices)
    vertex = rounded(model.to_face(vertex));
  for (std::array<float, 3>& normal : skin.normals)
    normal = rounded(model.to_face.turned(normal));
  for (std::array<float, 3>& landmark : skin.landmarks)
    landmark = rounded(model.to_face(landmark));
}

std::vector<BodyFrame> bodies_in_face_frame(const Solver& solver, const Model& model)
{
  const std::vector<Reaction> reactions = solver.reactions();
  const std::vector<TouchedBody> touched = touched_bodies(model);
  std::vector<RigidTransform> poses = solver.bodies();
  // A backend without pushed bodies returns no poses. Its bodies move with their bones.
  for (std::size_t c = poses.size(); c < reactions.size(); ++c)
    poses.push_back(touched[c].bone < 0 ? RigidTransform() : solver.controls().bone[touched[c].bone]);
  std::vector<BodyFrame> bodies;
  bodies.reserve(reactions.size());
  for (std::size_t c = 0; c < reactions.size(); ++c)
    bodies.push_back(in_face_frame(model, reactions[c], poses[c]));
  return bodies;
}

std::vector<BodyFrame> bones_in_face_frame(Solver& solver, const Model& model, bool forces)
{
  BoneForces bones{ solver.controls().bone, std::vector<Reaction>(model.bones.size()) };
  if (forces && !model.bones.empty())
  {
    std::vector<std::array<double, 3>> internal, displaced;
    solver.internal_forces(internal);
    solver.displacements(displaced);
    const auto force_of = [&](std::int32_t node) { return -1.0 * vector_of(internal[static_cast<std::size_t>(node)]); };
    const auto rest_of = [&](std::int32_t node) { return rest_position(model, static_cast<std::size_t>(node)); };
    const auto place_of = [&](std::int32_t node)
    { return vector_of(rest_of(node)) + vector_of(displaced[static_cast<std::size_t>(node)]); };
    const auto surface_of = [&](std::int32_t surface) -> const ConstraintSurface&
    { return model.constraint_surfaces[static_cast<std::size_t>(surface)]; };
    for (const RigidNode& rigid : model.rigid)
      bones.add_at(rigid.bone, place_of(rigid.node), force_of(rigid.node));
    const EffectSet effects = solver.effects();
    for (const SlidingNode& sliding : model.sliding)
    {
      const ConstraintSurface& surface = surface_of(sliding.surface);
      if (surface.bone < 0 || !effects.has(Effect::sliding))
        continue;
      const Vector at = place_of(sliding.node);
      const double friction = effects.has(Effect::friction) ? surface.friction : 0;
      const Vector normal = normal_at(surface, bones.pose_of(surface.bone), at);
      bones.add_at(surface.bone, at, carried(normal, friction, force_of(sliding.node)));
    }
    // An attached node moves by the share `ratio` of its master's motion relative to the bone. By the principle of
    // virtual work, the master feels that share of the force, and the bone feels the rest.
    for (const AttachedNode& attached : model.attached)
    {
      const Vector force = force_of(attached.node);
      if (attached.surface < 0)
      {
        const RigidTransform pose = bones.pose_of(attached.bone);
        bones.add_at(attached.bone, vector_of(pose(rest_of(attached.node))), force);
        bones.add_at(attached.bone, vector_of(pose(rest_of(attached.master))), -attached.ratio * force);
        continue;
      }
      const ConstraintSurface& surface = surface_of(attached.surface);
      if (surface.bone < 0)
        continue;
      const RigidTransform pose = bones.pose_of(surface.bone);
      const Vector at = place_of(attached.node), master = place_of(attached.master);
      const Vector normal = normal_at(surface, pose, at);
      bones.add_at(surface.bone, at, dot(normal, force) * normal);
      bones.add_at(surface.bone, master, -attached.ratio * dot(normal, force) * normal_at(surface, pose, master));
    }
    const std::vector<TouchedBody> touched = touched_bodies(model);
    const std::vector<Reaction> reactions = solver.reactions();
    for (std::size_t c = 0; c < reactions.size(); ++c)
      bones.add(touched[c].bone, vector_of(reactions[c].force), vector_of(reactions[c].moment));
  }
  std::vector<BodyFrame> out;
  out.reserve(model.bones.size());
  for (std::size_t b = 0; b < model.bones.size(); ++b)
    out.push_back(in_face_frame(model, bones.sum[b], bones.pose[b]));
  return out;
}

bool is_finite(const SkinState& skin)
{
  return all_finite(skin.vertices) && all_finite(skin.normals) && all_finite(skin.landmarks);
}

}  // namespace frontalis
