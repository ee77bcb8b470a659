#pragma once

#include "frontalis/solver/solver.hpp"

namespace frontalis
{

/// Transforms vertices [m], normals and landmarks [m] from the model's local frame to the face frame.
void to_face_frame(const Model& model, SkinState& skin);

/// Whether all coordinates of vertices, normals and landmarks are finite.
bool is_finite(const SkinState& skin);

}  // namespace frontalis
