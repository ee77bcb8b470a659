#pragma once

#include "frontalis/model/model.hpp"

#include <map>
#include <string>
#include <vector>

namespace frontalis
{

/// Reads "frontalis_left=0.75,procerus=0.2". Throws WrongUsage where it is not written so.
std::map<std::string, double> parse_activation_list(const std::string& text);

/// One activation a muscle: those of the expression (may be empty), then those listed; the rest are 0. Throws Error
/// naming each muscle or expression that the model does not have and those that it has, and values outside 0..1.
std::vector<float> target_activation(const Model& model, const std::string& expression,
                                     const std::map<std::string, double>& listed);

/// Reads "jaw=0,0,-2,0,10,0", one a bone: shift along x, y, z [mm], and rotation vector [degrees] about the origin,
/// both in the face frame. Returns one motion a bone of the model, in the local frame. Throws WrongUsage where it is
/// not written so, and Error on unknown bones and motions that are not finite.
std::vector<RigidTransform> parse_bone_motions(const Model& model, const std::vector<std::string>& texts);

}  // namespace frontalis
