#pragma once

#include "frontalis/scene/geometry.hpp"

#include <cstring>
#include <map>
#include <string>
#include <vector>

namespace frontalis
{

/// Motion of a bone from its rest pose, in the face frame.
struct BonePose
{
  std::string bone;
  Vector3 shift{ 0, 0, 0 };  ///< translation after the rotation [m]
  Vector3 turn{ 0, 0, 0 };   ///< rotation vector about the bone's centre (Scene::bone_centres) [rad]
  double angle = 0;          ///< angle of the bone's joint (Scene::joints) [rad]; replaces shift and turn
};

/// Orders names as text, but digits in them as numbers (glibc's strverscmp()): AU2 is before AU12.
struct NumbersInNames
{
  bool operator()(const std::string& a, const std::string& b) const { return strverscmp(a.c_str(), b.c_str()) < 0; }
};

/// Activations and poses of bones of an expression or an action unit at full intensity.
struct FacePose
{
  /// Change of each muscle's activation, -1..1. Its sum with the muscle's tone is limited to 0..1.
  std::map<std::string, double> activation;
  std::vector<BonePose> bones;  ///< poses of bones; other bones stay where they are
};
using FacePoses = std::map<std::string, FacePose, NumbersInNames>;

/// One phase of the demonstration: a linear ramp to an expression and to poses of bones, which are then held.
struct DemoPhase
{
  std::string expression;       ///< empty: as in the previous phase
  std::vector<BonePose> bones;  ///< poses of bones; other bones stay where they are
  double ramp = 0.3;            ///< duration of the ramp [simulated s]
  double seconds = 1.0;         ///< duration of the phase, including the ramp [simulated s]
};

}  // namespace frontalis
