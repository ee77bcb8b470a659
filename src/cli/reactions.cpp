#include "cli/reactions.hpp"

#include "frontalis/model/effects.hpp"
#include "frontalis/physics/number.hpp"
#include "frontalis/solver/rigid_motion.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace frontalis
{
namespace
{

using Vector = physics::Vec3<double>;

Vector vector(const std::array<double, 3>& a) { return { a[0], a[1], a[2] }; }

}  // namespace

std::vector<Reaction> reactions_in_face_frame(const Solver& solver, const Model& model)
{
  std::vector<Reaction> reactions = solver.reactions();
  const std::vector<TouchedBody> bodies = touched_bodies(model);
  const std::array<double, 3> origin = inverse(model.to_face).translation;
  for (std::size_t c = 0; c < reactions.size(); ++c)
  {
    const std::int32_t bone = bodies[c].bone;
    const RigidTransform pose = bone < 0 ? RigidTransform() : solver.controls().bone[bone];
    auto& [force, moment] = reactions[c];
    // move the reference point from the origin of the local frame to that of the face frame, both moved with the body
    const Vector about_face = vector(moment) - cross(vector(pose.turned(origin)), vector(force));
    force = model.to_face.turned(force);
    moment = model.to_face.turned(std::array<double, 3>{ { about_face.x, about_face.y, about_face.z } });
  }
  return reactions;
}

void print_reactions(const Model& model, const std::vector<Reaction>& reactions)
{
  const std::vector<TouchedBody> bodies = touched_bodies(model);
  for (std::size_t c = 0; c < reactions.size(); ++c)
  {
    const auto& [force, moment] = reactions[c];
    fmt::print(
        "reaction           {}: {:+.4g} N forward, {:+.4g} N left, {:+.4g} N up; moment {:+.4g}, {:+.4g}, {:+.4g} "
        "N m\n",
        bodies[c].name, force[0], force[1], force[2], moment[0], moment[1], moment[2]);
  }
}

std::string reaction_rows(const Model& model, int frame, double time, const std::vector<Reaction>& reactions)
{
  std::string rows;
  const std::vector<TouchedBody> bodies = touched_bodies(model);
  for (std::size_t c = 0; c < reactions.size(); ++c)
  {
    const auto& [force, moment] = reactions[c];
    rows += fmt::format("{},{:.6f},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", frame, time, bodies[c].name,
                        force[0], force[1], force[2], moment[0], moment[1], moment[2]);
  }
  return rows;
}

}  // namespace frontalis
