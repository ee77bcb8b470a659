#pragma once

#include "frontalis/solver/solver.hpp"

namespace frontalis
{

/// Transforms vertices [m], normals and landmarks [m] from the model's local frame to the face frame.
void to_face_frame(const Model& model, SkinState& skin);

/// The skin's vertices [m], normals and landmarks [m] at rest, in the face frame, without fine lines.
SkinState rest_in_face(const Model& model);

/// Whether all coordinates of vertices, normals and landmarks are finite.
bool is_finite(const SkinState& skin);

/// A body that tissue touches, or a bone.
struct BodyFrame
{
  Reaction reaction;    ///< face axes [N]; moment about the body's point that rests at the face frame's origin [N m]
  RigidTransform pose;  ///< motion from the rest pose, in the face frame
};
/// Motions and reactions of touched_bodies(model) in the latest step, in their order; empty if the backend computes no
/// contact.
std::vector<BodyFrame> bodies_in_face_frame(const Solver& solver, const Model& model);
/// Motions and reactions of the model's bones, in their order. With `forces`, the reaction of a bone is the force of
/// the tissue whose nodes the bone holds, of the tissue that slides on its surfaces and of the tissue that touches its
/// bodies; without, it is 0. Held and sliding nodes count by their elastic and fibre forces and, on a CPU, by those of
/// contact and shells; their inertia, viscosity and weight do not count.
std::vector<BodyFrame> bones_in_face_frame(Solver& solver, const Model& model, bool forces);

}  // namespace frontalis
