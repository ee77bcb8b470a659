#include "cli/reactions.hpp"

#include "frontalis/physics/pose.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace frontalis
{
namespace
{

using Vector = physics::Vec3<double>;

Vector vector(const std::array<double, 3>& a) { return { a[0], a[1], a[2] }; }

physics::Pose pose_of(const RigidTransform& from)
{
  physics::Pose pose;
  std::copy(from.rotation.begin(), from.rotation.end(), pose.r);
  std::copy(from.translation.begin(), from.translation.end(), pose.t);
  return pose;
}

}  // namespace

std::vector<Reaction> reactions_in_face_frame(const Solver& solver, const Model& model)
{
  std::vector<Reaction> reactions = solver.reactions();
  const physics::Pose to_face = pose_of(model.to_face);
  const Vector origin = to_face.inwards({ 0, 0, 0 });
  for (std::size_t c = 0; c < reactions.size(); ++c)
  {
    const std::int32_t bone = model.contacts[c].bone;
    const physics::Pose pose = pose_of(bone < 0 ? RigidTransform() : solver.controls().bone[bone]);
    const Vector force = vector(reactions[c].force);
    // from the origin of the local frame to that of the face frame, both carried by the body
    const Vector moment = vector(reactions[c].moment) - cross(pose.turned(origin), force);
    const Vector f = to_face.turned(force), m = to_face.turned(moment);
    reactions[c] = { { { f.x, f.y, f.z } }, { { m.x, m.y, m.z } } };
  }
  return reactions;
}

void print_reactions(const Model& model, const std::vector<Reaction>& reactions)
{
  for (std::size_t c = 0; c < reactions.size(); ++c)
  {
    const auto& [force, moment] = reactions[c];
    fmt::print(
        "reaction           {}: {:+.4g} N forward, {:+.4g} N left, {:+.4g} N up; moment {:+.4g}, {:+.4g}, {:+.4g} "
        "N m\n",
        model.contacts[c].name, force[0], force[1], force[2], moment[0], moment[1], moment[2]);
  }
}

std::string reaction_rows(const Model& model, int frame, double time, const std::vector<Reaction>& reactions)
{
  std::string rows;
  for (std::size_t c = 0; c < reactions.size(); ++c)
  {
    const auto& [force, moment] = reactions[c];
    rows += fmt::format("{},{:.6f},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", frame, time, model.contacts[c].name,
                        force[0], force[1], force[2], moment[0], moment[1], moment[2]);
  }
  return rows;
}

}  // namespace frontalis
