#include "frontalis/runner/face_frame.hpp"

#include "frontalis/model/effects.hpp"
#include "frontalis/physics/number.hpp"
#include "frontalis/runner/named_controls.hpp"
#include "frontalis/solver/rigid_motion.hpp"
#include "frontalis/solver/surface_normals.hpp"
#include "runner/bone_forces.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

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
  const std::vector<RigidTransform> poses = solver.bodies();
  std::vector<BodyFrame> bodies;
  bodies.reserve(reactions.size());
  for (std::size_t c = 0; c < reactions.size(); ++c)
    bodies.push_back(in_face_frame(model, reactions[c], poses.at(c)));
  return bodies;
}

std::vector<BodyFrame> bones_in_face_frame(Solver& solver, const Model& model, bool forces)
{
  std::vector<Reaction> sums(model.bones.size());
  if (forces && !sums.empty())
  {
    BoneForces bones(solver, model);
    for (const RigidNode& rigid : model.rigid)
      bones.add_at(rigid.bone, bones.place_of(rigid.node), bones.force_of(rigid.node));
    add_sliding_nodes(bones);
    add_attached_nodes(bones);
    const std::vector<TouchedBody> touched = touched_bodies(model);
    const std::vector<Reaction> reactions = solver.reactions();
    for (std::size_t c = 0; c < reactions.size(); ++c)
      bones.add(touched[c].bone, vector_of(reactions[c].force), vector_of(reactions[c].moment));
    sums = std::move(bones.sum);
  }
  std::vector<BodyFrame> out;
  out.reserve(sums.size());
  for (std::size_t b = 0; b < sums.size(); ++b)
    out.push_back(in_face_frame(model, sums[b], solver.controls().bone[b]));
  return out;
}

SkinState rest_in_face(const Model& model)
{
  SkinState skin;
  std::transform(model.skin.vertices.begin(), model.skin.vertices.end(), std::back_inserter(skin.vertices), rounded);
  std::transform(model.landmark_positions.begin(), model.landmark_positions.end(), std::back_inserter(skin.landmarks),
                 rounded);
  to_face_frame(model, skin);
  surface_normals(model.skin.triangles, skin.vertices, skin.normals);
  return skin;
}

bool is_finite(const SkinState& skin)
{
  return all_finite(skin.vertices) && all_finite(skin.normals) && all_finite(skin.landmarks);
}

}  // namespace frontalis
