#pragma once

#include "frontalis/solver/solver.hpp"

#include <string>
#include <vector>

namespace frontalis
{

/// The reactions of a solver in the axes of the face frame. Moments are about the point to which the body has moved the
/// origin of the face frame: the centre of rotations given with `--bone`.
std::vector<Reaction> reactions_in_face_frame(const Solver& solver, const Model& model);

void print_reactions(const Model& model, const std::vector<Reaction>& reactions);

/// Header of a table (CSV) with one row per frame and body.
inline const std::string reaction_heading =
    "frame,time_s,body,force_x_N,force_y_N,force_z_N,moment_x_Nm,moment_y_Nm,"
    "moment_z_Nm\n";
std::string reaction_rows(const Model& model, int frame, double time, const std::vector<Reaction>& reactions);

}  // namespace frontalis
