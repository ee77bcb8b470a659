#pragma once

#include "frontalis/effect.hpp"
#include "frontalis/scene/expression.hpp"
#include "frontalis/scene/geometry.hpp"
#include "frontalis/scene/head_template.hpp"
#include "frontalis/scene/restriction.hpp"
#include "frontalis/scene/tissue.hpp"

#include <map>
#include <string>
#include <vector>

namespace frontalis
{

/// Stiff film on a part of the skin, which wrinkles in lines that are finer than voxels (FilmLaw).
struct SceneFilm
{
  std::string material;
  double thickness = 0;  ///< [m]
  std::string base;      ///< material below it
  double stretch = 0;    ///< strain of the film at rest
  Region crop;           ///< where the skin has it
};

struct SceneSkin
{
  std::string surface;
  Region crop;               ///< the published skin is cut at the sides of this box
  double extrapolation = 0;  ///< largest distance of a vertex from its voxel [m]; 0: two voxel edges
};

struct SceneLandmark
{
  std::string name;
  Vector3 position{ 0, 0, 0 };  ///< scene coordinates [m]; moved to the closest point of the skin
  int line = 0;
  /// The generated head whose landmark this is; it replaces `position`. The landmark is left out if it is beyond the
  /// published skin.
  std::optional<Shape> head{};
  HeadTemplate::Point point{};  ///< the landmark's definition in the template of `head`
};

/// The joint that turns a bone by one angle.
struct SceneJoint
{
  std::string bone;
  HeadTemplate::Joint joint;
  std::optional<Shape> head;  ///< set: `joint` is that of the template's default head; empty: in scene axes
};

/// Pose of the published frame in the scene (REP-155 face frame: origin at the sellion, x out of the face, z up).
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
    uniform,   ///< every density is multiplied by `factor`
    selective  ///< mass is added to voxels with one of `materials` (empty: all) to reach `time_step`
  };
  Kind kind = Kind::none;
  double factor = 1;
  std::vector<std::string> materials;
  double time_step = 0;  ///< critical time step of these voxels [s]; 0: equal to that of all other voxels
  double in_motion = 0;  ///< uniform: time step that distorted voxels do not shorten [s]; 0: they do
};

/// Result of the command `frontalis accuracy` for a profile; see doc/accuracy.md.
struct MeasuredAccuracy
{
  double error = 0;     ///< RMS error of the skin's vertices [m]; 0: not measured
  double cost = 0;      ///< wall seconds per simulated second; 0: not measured
  std::string machine;  ///< computer on which the cost was measured
};

/// A named compromise between accuracy and computing time.
struct AccuracyProfile
{
  std::string name;
  Vector3 voxel{ 1e-3, 1e-3, 1e-3 };  ///< voxel edges [m]
  int samples = 4;                    ///< sample points per voxel edge in boundary voxels
  double fill_min = 0.2;              ///< voxels with a smaller proportion of tissue are left out
  double time_step_share = 0.9;       ///< time step as a proportion of the critical time step
  MassScaling mass_scaling;
  double bulk_modulus_max = 0;            ///< upper limit of bulk moduli [Pa] (physics::limited_bulk_modulus); 0: none
  bool assumed_strain = false;            ///< hourglass control: assumed strain instead of a scalar stiffness
  std::string integration = "one_point";  ///< or selective_reduced
  std::string precision = "single";       ///< or compensated, double; used by the CPU backend
  std::string time_step = "element";      ///< source of the critical time step: element (a bound per node) or assembled
  std::string fibres = "sampled";  ///< voxels that a muscle acts on: sampled (those it fills) or spread (also around)
  std::string boundary = "staircase";  ///< where bones hold tissue: staircase (nodes near them) or true (their surface)
  std::string gaps = "glued";          ///< the sides of a gap thinner than a voxel: glued or parted
  MeasuredAccuracy measured;
};

struct SceneTime
{
  double damping = 0;      ///< mass-proportional damping coefficient [1/s]
  double scaling = 1;      ///< time scaling: simulated motions are this many times as fast as real ones
  double frame_rate = 30;  ///< skins published per wall second [1/s]
  /// Largest rate of change of a muscle's activation [1/s], before time scaling; 0: no limit.
  double activation_slew = 0;
};

/// Contents of a scene file, in SI units. doc/scene.md documents every key of the file.
struct Scene
{
  std::string file;
  double unit = 1e-3;  ///< length unit of plain numbers in the file and of lengths in messages [m]
  std::vector<Surface> surfaces;
  std::vector<Volume> volumes;
  std::vector<SceneMaterial> materials;
  std::vector<Layer> layers;
  std::vector<SceneMuscle> muscles;
  std::vector<SceneWeakness> weakness;
  std::vector<SceneConstraint> constraints;
  std::vector<SceneLoad> loads;
  std::vector<SceneLandmark> landmarks;
  std::vector<SceneJoint> joints;
  SceneSkin skin;
  FaceFrame frame;
  Vector3 gravity{ 0, 0, 0 };  ///< scene coordinates [m/s2]
  EffectSet switched_off;      ///< effects that the bake leaves out
  SceneTime time;
  AccuracyProfile accuracy;  ///< the chosen profile
  std::vector<AccuracyProfile> profiles;
  /// Centres of the rotations of bones in poses [m]. Other bones rotate about the face frame's origin.
  std::map<std::string, Vector3> bone_centres;
  FacePoses action_units, expressions;
  std::vector<DemoPhase> demo;
  std::string content;  ///< canonical text of all that the bake depends on, hashes of files included: key of caches
  std::vector<SceneFilm> films{};  ///< of parts of the skin; a later one replaces earlier ones where it is
};

}  // namespace frontalis
