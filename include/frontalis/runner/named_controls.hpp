#pragma once

#include "frontalis/solver/solver.hpp"

#include <map>
#include <string>
#include <vector>

namespace frontalis
{

/// Sets activations by muscle name, 0..1; muscles not named keep theirs. Throws Error naming each unknown muscle, those
/// that exist, and each bad value (not finite, out of range); nothing is changed then.
void set_activations(const Model& model, const std::map<std::string, double>& named, std::vector<float>& activation);

/// One activation a muscle of a named expression; muscles that it does not name are at 0, all with `relax`. Throws
/// Error naming those that exist.
std::vector<float> expression_activation(const Model& model, const std::string& name);

/// Sets the motion of a bone from its rest pose, given in the face frame. Throws Error where there is no such bone,
/// naming those that exist, or where the motion is not finite and rigid; nothing is changed then.
void set_bone_motion(const Model& model, const std::string& name, const RigidTransform& motion,
                     std::vector<RigidTransform>& bones);

}  // namespace frontalis
