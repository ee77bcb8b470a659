#pragma once

#include "frontalis/runner/named_controls.hpp"

#include <map>
#include <string>
#include <vector>

namespace frontalis
{

/// Reads "frontalis_left=0.75,procerus=0.2". Throws WrongUsage on any other form.
std::map<std::string, double> parse_activation_list(const std::string& text);

/// The controls of an expression (empty: relax). Activations in the list replace those of the expression. Throws Error
/// on values outside 0..1, and on unknown muscles and expressions, with a list of the known ones.
Controls target_controls(const Model& model, const std::string& expression,
                         const std::map<std::string, double>& listed);

/// Reads "jaw=0,0,-2,0,10,0", one text per bone: shift along x, y, z [mm] and rotation vector about the origin
/// [degrees], both in the face frame. Sets the motions of these bones in the local frame. Throws WrongUsage on any
/// other form, and Error on unknown bones and on motions that are not finite.
void parse_bone_motions(const Model& model, const std::vector<std::string>& texts, std::vector<RigidTransform>& bones);

/// The curve of controls from rest to a target, over a linear ramp of `ramp` seconds.
ControlCurve ramp_to(const Controls& target, double ramp);

/// Reads a table with a header `time,NAME,NAME,...` and one row per knot, times ascending. A name is a muscle, or a
/// bone and one of .x .y .z [mm] .rx .ry .rz [degrees], which mean the same as in parse_bone_motions(). Before the
/// first row all values grow linearly from 0. Throws Error with the file's line.
ControlCurve read_control_curve(const std::string& path, const Model& model);

/// Returns the curve with its motions of bones replaced: bones whose target differs from rest move there over a ramp.
ControlCurve with_bones(const ControlCurve& curve, const std::vector<RigidTransform>& targets, double ramp);

}  // namespace frontalis
