#pragma once

#include "frontalis/solver/solver.hpp"

#include <map>
#include <string>
#include <vector>

namespace frontalis
{

/// Sets activations (0..1) by the names of muscles; other muscles keep their activations. If a name is unknown or a
/// value is not within 0..1, nothing is changed and an Error names all of them and the existing muscles.
void set_activations(const Model& model, const std::map<std::string, double>& named, std::vector<float>& activation);

/// All muscles at their tone and all bones at rest: the expression `relax`.
Controls rest_controls(const Model& model);

/// A named expression of the model, added to rest_controls(); activations are limited to 0..1. If no expression has the
/// name and it ends in _left or _right, half of an expression is meant: muscles and bones of that side move fully,
/// those without a side half as much, and those of the other side not at all. Throws an Error that lists the existing
/// expressions if the name is unknown.
Controls expression_controls(const Model& model, const std::string& name);

/// Like expression_controls(), for a sum of action units: intensities (0..1) by names such as AU12 or AU12_left. The
/// FACS letters A to E in a name (AU12C, AU12C_left) multiply the intensity by 0.2, 0.4, 0.6, 0.8 and 1.
Controls action_unit_controls(const Model& model, const std::map<std::string, double>& intensities);

/// Named values added to rest_controls(). The name of a muscle sets its activation (0..1). BONE.x, .y or .z shifts a
/// bone from its rest pose along an axis of the face frame [mm]; BONE.rx, .ry or .rz is a component of its rotation
/// vector about the frame's origin [degrees]. Throws an Error that names what is unknown or out of range.
Controls value_controls(const Model& model, const std::map<std::string, double>& values);

/// Sets all activations, and the motions of the bones that expressions or action units of the model move.
void take_pose(const Model& model, const Controls& pose, Controls& controls);

/// Sets the motion of a bone from its rest pose, given in the face frame. If no bone has the name, or the motion is not
/// finite and rigid, nothing is changed, and an Error says so and lists the existing bones.
void set_bone_motion(const Model& model, const std::string& name, const RigidTransform& motion,
                     std::vector<RigidTransform>& bones);

/// The motion of a bone in the face frame, from its motion in the local frame.
RigidTransform motion_in_face(const Model& model, const RigidTransform& local);

/// Controls over time, linear between knots and constant after the last one.
struct ControlCurve
{
  std::vector<double> time;  ///< ascending or equal, from 0 [s]: simulated time multiplied by Model::time_scaling
  std::vector<Controls> controls;

  Controls at(double seconds) const;
};

/// One round of the model's demo that begins at given controls. Each phase ramps from the controls at the end of the
/// previous phase; a ramp that is longer than its phase is shortened to the phase. The last knot is the end of the
/// round. The curve of a model without a demo has only the first knot.
ControlCurve demo_curve(const Model& model, const Controls& begin);

}  // namespace frontalis
