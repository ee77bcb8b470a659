#pragma once

#include "frontalis/solver/solver.hpp"

namespace frontalis
{

/// Takes vertices, normals and landmarks from the local to the face frame [m].
void to_face_frame(const Model& model, SkinState& skin);

/// Whether every coordinate is finite.
bool is_finite(const SkinState& skin);

}  // namespace frontalis
