#include "frontalis/runner/face_frame.hpp"

#include "frontalis/model/effects.hpp"
#include "frontalis/physics/number.hpp"
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
  using Vector = physics::Vec3<double>;
  const auto vector = [](const std::array<double, 3>& a) { return Vector{ a[0], a[1], a[2] }; };
  const std::vector<Reaction> reactions = solver.reactions();
  const std::vector<TouchedBody> touched = touched_bodies(model);
  std::vector<RigidTransform> poses = solver.bodies();
  // a backend that knows of no body that is pushed leaves them where their bones are
  for (std::size_t c = poses.size(); c < reactions.size(); ++c)
    poses.push_back(touched[c].bone < 0 ? RigidTransform() : solver.controls().bone[touched[c].bone]);
  const std::array<double, 3> origin = inverse(model.to_face).translation;
  std::vector<BodyFrame> bodies;
  for (std::size_t c = 0; c < reactions.size(); ++c)
  {
    const auto& [force, moment] = reactions[c];
    // from the origin of the local frame to that of the face frame, both carried by the body
    const Vector about_face = vector(moment) - cross(vector(poses[c].turned(origin)), vector(force));
    bodies.push_back({ { model.to_face.turned(force),
                         model.to_face.turned(std::array<double, 3>{ { about_face.x, about_face.y, about_face.z } }) },
                       motion_in_face(model, poses[c]) });
  }
  return bodies;
}

std::vector<std::array<double, 3>> bone_centres(const Model& model)
{
  std::vector<std::array<double, 3>> centres(model.bones.size());
  std::vector<bool> known(model.bones.size(), false);
  const auto set = [&](std::int32_t bone, const std::array<double, 3>& centre)
  {
    if (bone < 0 || known[bone])
      return;
    centres[bone] = centre;
    known[bone] = true;
  };
  for (const ConstraintSurface& surface : model.constraint_surfaces)
    if (surface.field.radius > 0)
      set(surface.bone, model.to_face(surface.field.origin));
  const auto set_all = [&](const auto& poses)
  {
    for (const auto& pose : poses)
      for (const Model::BonePose& bone : pose.bones)
        set(bone.bone, bone.centre);
  };
  set_all(model.action_units);
  set_all(model.expressions);
  set_all(model.demo);
  return centres;
}

bool is_finite(const SkinState& skin)
{
  return all_finite(skin.vertices) && all_finite(skin.normals) && all_finite(skin.landmarks);
}

}  // namespace frontalis
