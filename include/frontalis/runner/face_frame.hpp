#pragma once

#include "frontalis/solver/solver.hpp"

namespace frontalis
{

/// Transforms vertices [m], normals and landmarks [m] from the model's local frame to the face frame.
void to_face_frame(const Model& model, SkinState& skin);

/// Whether all coordinates of vertices, normals and landmarks are finite.
bool is_finite(const SkinState& skin);

/// A body that tissue touches.
struct BodyFrame
{
  Reaction reaction;  ///< face axes [N], moment about the origin of the face frame where the body has carried it [N m]
  RigidTransform pose;  ///< motion from its place at rest, in the face frame
};
/// One per entry of Model::contacts, in the latest step; none where the backend computes no contact.
std::vector<BodyFrame> bodies_in_face_frame(const Solver& solver, const Model& model);

/// The points that bones turn about, at rest in the face frame [m]: the centre of a ball that tissue slides on, else
/// the centre of the first pose of the bone in the action units, expressions and demo, else the origin.
std::vector<std::array<double, 3>> bone_centres(const Model& model);

}  // namespace frontalis
