#pragma once

#include "frontalis/solver/solver.hpp"

namespace frontalis
{

/// Transforms vertices [m], normals and landmarks [m] from the model's local frame to the face frame.
void to_face_frame(const Model& model, SkinState& skin);

/// Whether all coordinates of vertices, normals and landmarks are finite.
bool is_finite(const SkinState& skin);

/// A body that tissue touches, or a bone.
struct BodyFrame
{
  Reaction reaction;    ///< face axes [N]; moment about the body's point that rests at the face frame's origin [N m]
  RigidTransform pose;  ///< motion from its place at rest, in the face frame
};
/// One per entry of touched_bodies(model), in the latest step; none if the backend computes no contact.
std::vector<BodyFrame> bodies_in_face_frame(const Solver& solver, const Model& model);
/// One per bone of the model. If `forces`, its reaction is the force of the tissue whose nodes it holds, without the
/// inertia and viscosity of that tissue and without shells, and of the tissue that its bodies touch; else it is 0.
/// Sliding nodes and nodes attached at true boundaries are not counted.
std::vector<BodyFrame> bones_in_face_frame(Solver& solver, const Model& model, bool forces);

}  // namespace frontalis
