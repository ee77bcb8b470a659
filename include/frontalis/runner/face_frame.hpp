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
  Reaction reaction;  ///< face axes [N], moment about the origin of the face frame where the body has carried it [N m]
  RigidTransform pose;  ///< motion from its place at rest, in the face frame
};
/// One per entry of Model::contacts, in the latest step; none where the backend computes no contact.
std::vector<BodyFrame> bodies_in_face_frame(const Solver& solver, const Model& model);
/// One per bone of the model. If `forces`, the reaction is that of the tissue whose nodes the bone holds, without that
/// tissue's own inertia and viscosity and without shells, and of tissue that bodies of the bone touch; else it is 0.
/// Sliding nodes and what is attached at true boundaries are not counted.
std::vector<BodyFrame> bones_in_face_frame(Solver& solver, const Model& model, bool forces);

}  // namespace frontalis
