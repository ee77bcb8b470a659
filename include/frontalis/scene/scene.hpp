#pragma once

#include "frontalis/effect.hpp"
#include "frontalis/scene/geometry.hpp"
#include "frontalis/scene/restriction.hpp"
#include "frontalis/scene/tissue.hpp"

#include <map>
#include <string>
#include <vector>

namespace frontalis
{

struct SceneSkin
{
  std::string surface;
  Region crop;               ///< the skin is cut at its sides
  double extrapolation = 0;  ///< farthest that a vertex may lie outside its voxel [m]; 0: two voxels
};

struct SceneLandmark
{
  std::string name;
  Vector3 position{ 0, 0, 0 };  ///< scene coordinates [m]; taken to the closest point of the skin
  int line = 0;
};

/// Where the published frame (REP-155 face frame: origin at the sellion, x out of the face, z up) stands in the scene.
struct FaceFrame
{
  std::string id = "face";
  Vector3 origin{ 0, 0, 0 };  ///< scene coordinates [m]
  Vector3 forward{ 1, 0, 0 };
  Vector3 up{ 0, 0, 1 };
};

struct MassScaling
{
  enum class Kind
  {
    none,
    uniform,   ///< every density times `factor`
    selective  ///< voxels with one of `materials` (none given: all) get mass until they allow `time_step`
  };
  Kind kind = Kind::none;
  double factor = 1;
  std::vector<std::string> materials;
  double time_step = 0;  ///< that they must allow [s]; 0: as much as the other voxels allow
};

/// What `frontalis accuracy` found for a setting; doc/accuracy.md.
struct MeasuredAccuracy
{
  double error = 0;     ///< of the skin, RMS [m]; 0: not measured
  double cost = 0;      ///< wall seconds per simulated second; 0: not measured
  std::string machine;  ///< on which it was measured
};

/// One named setting of accuracy against time.
struct AccuracyProfile
{
  std::string name;
  Vector3 voxel{ 1e-3, 1e-3, 1e-3 };  ///< voxel edges [m]
  int samples = 4;                    ///< sample points per voxel edge in boundary voxels
  double fill_min = 0.2;              ///< a voxel with less tissue than this proportion is dropped
  double time_step_share = 0.9;       ///< share of the critical time step that is used
  MassScaling mass_scaling;
  bool assumed_strain = false;            ///< hourglass control: assumed strain instead of one stiffness per voxel
  std::string integration = "one_point";  ///< or selective_reduced
  std::string precision = "single";       ///< compensated, double: of the CPU backend
  std::string time_step = "element";      ///< critical time step: bounded at nodes, or of the assembled model
  MeasuredAccuracy measured;
};

/// Time settings.
struct SceneTime
{
  double damping = 0;      ///< mass-proportional damping coefficient [1/s]
  double scaling = 1;      ///< time scaling: the motion is played this many times faster in simulated time
  double frame_rate = 30;  ///< skins published per wall second [1/s]
  /// Fastest change of a muscle's activation, on the clock on which activations are given [1/s]; 0: no limit.
  double activation_slew = 0;
};

/// One entry of the demonstration: hold an expression for some seconds; the change into it is a linear ramp.
struct DemoPhase
{
  std::string expression;
  double ramp = 0.3;     ///< [s] simulated
  double seconds = 1.0;  ///< [s] simulated, ramp included
};

/// What to simulate, as the user wrote it, in SI units. doc/scene.md documents the file key by key.
struct Scene
{
  std::string file;
  double unit = 1e-3;  ///< metres per plain number of the file; messages give lengths and places in it
  std::vector<Surface> surfaces;
  std::vector<Volume> volumes;
  std::vector<SceneMaterial> materials;
  std::vector<Layer> layers;
  std::vector<SceneMuscle> muscles;
  std::vector<SceneConstraint> constraints;
  std::vector<SceneLoad> loads;
  std::vector<SceneLandmark> landmarks;
  SceneSkin skin;
  FaceFrame frame;
  Vector3 gravity{ 0, 0, 0 };  ///< scene coordinates [m/s2]
  EffectSet switched_off;      ///< effects that the bake leaves out
  SceneTime time;
  AccuracyProfile accuracy;  ///< the profile chosen
  std::vector<AccuracyProfile> profiles;
  std::map<std::string, std::map<std::string, double>> expressions;  ///< preset -> muscle -> activation 0..1
  std::vector<DemoPhase> demo;
  std::string content;  ///< everything that decides the bake, as canonical text with the hashes of its files: the key
                        ///< of cached models
};

}  // namespace frontalis
