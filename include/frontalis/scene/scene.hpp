#pragma once

#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace frontalis
{

using Vector3 = std::array<double, 3>;

/// Axis-aligned box in scene coordinates [m]; a side that is not given lies at infinity.
struct Region
{
  Vector3 lower{ -std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
                 -std::numeric_limits<double>::infinity() };
  Vector3 upper{ std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                 std::numeric_limits<double>::infinity() };
};

/// A surface that the package makes itself. Which fields count depends on the kind; lengths in metres.
struct Shape
{
  enum class Kind
  {
    box,        ///< centre, size (full edge lengths)
    sphere,     ///< centre, radius
    ellipsoid,  ///< centre, size (semi-axes)
    cylinder,   ///< centre, axis, radius, length; closed by caps
    torus,      ///< centre, axis, radius (of the ring), minor_radius (of the tube)
    forehead    ///< part (skin, skull, rim, or a muscle of the generated forehead), forehead dimensions
  };
  Kind kind = Kind::box;
  Vector3 centre{ 0, 0, 0 };
  Vector3 size{ 0, 0, 0 };
  Vector3 axis{ 0, 0, 1 };
  double radius = 0;
  double minor_radius = 0;
  double length = 0;
  double edge = 0;   ///< wanted edge length of the triangles [m]; 0: chosen from the size
  std::string part;  ///< forehead only
  /// Dimensions of the generated forehead [m] by name; those not given have the defaults of doc/scene.md.
  std::map<std::string, double> dimensions;
};

struct Surface
{
  std::string name;
  std::string file;            ///< path, resolved against the mesh directory or the scene's; empty for a shape
  std::optional<Shape> shape;  ///< set where file is empty
  double unit = 1;             ///< metres a mesh unit (files only)
  int line = 0;                ///< line in the scene file, for messages of the bake
};

/// A set of points: inside the collection `closed_by` taken together (if given), inside at least one of `inside`
/// (if given), outside each of `outside`, at a depth in [depth_min, depth_max] below the surface `within` (if given)
/// with none of the surfaces `outside` on the straight way there, and inside `crop`.
struct Volume
{
  std::string name;
  std::vector<std::string> closed_by;
  std::vector<std::string> inside;
  std::vector<std::string> outside;
  std::string within;
  double depth_min = 0;
  double depth_max = 0;
  Region crop;
  std::string material;  ///< empty: the volume brings no material of its own (it only bounds something)
  int priority = 0;      ///< at a point in several volumes the highest priority wins; equals share the point
  bool tissue = false;   ///< voxels are made where tissue volumes are; other volumes only change what fills them
  int line = 0;
};

/// Passive material. Which parameters count depends on the law (physics/).
struct SceneMaterial
{
  std::string name;
  std::string law = "neo_hookean";
  double density = 0;  ///< [kg/m3]
  /// SI units, by name as in doc/scene.md: poisson, and by law young | c1, c2 | mu1, alpha1, mu2, alpha2 | shear, b |
  /// shear, k1, k2, dispersion.
  std::map<std::string, double> parameters;
  std::array<Vector3, 2> families{};  ///< holzapfel: directions of the two fibre families, scene axes, length 1
  int line = 0;
};

/// Skin layer of constant thickness, measured from a surface inwards; layers of one surface follow each other in order.
struct Layer
{
  std::string name;
  std::string surface;
  std::string volume;  ///< the tissue volume that it lies in
  std::string material;
  double thickness = 0;  ///< [m]
  int line = 0;
};

struct SceneMuscle
{
  std::string name;
  std::string volume;
  Vector3 fibre{ 0, 0, 1 };         ///< direction in scene coordinates; normalised
  double stress_reference = 0.3e6;  ///< sigma_max [Pa]
  bool passive = false;             ///< passive fibre stress of Blemker et al. 2005 too
  bool tension_length = true;       ///< active tension-length curve; without it f = 1
  int line = 0;
};

struct SceneConstraint
{
  enum class Kind
  {
    rigid,
    sliding
  };
  std::string name;
  Kind kind = Kind::rigid;
  std::vector<std::string> surfaces;
  double within = -1;  ///< tissue nodes no farther out of the surface than this are restricted [m]; < 0: 0.75 voxel
  Region crop;
  std::string bone;  ///< rigid nodes follow this bone's pose; empty: still
  int line = 0;
};

/// Load or prescribed motion on a named surface; all ramp linearly from 0 over `ramp` seconds.
struct SceneLoad
{
  enum class Kind
  {
    traction,     ///< value: force an area of the rest surface [Pa], dead
    pressure,     ///< value[0]: pressure [Pa] against the current outward normal (follower)
    displacement  ///< value: displacement [m] of the nodes near the surface; components not in `fixed` stay free
  };
  std::string name;
  Kind kind = Kind::traction;
  std::string surface;
  Vector3 value{ 0, 0, 0 };
  std::array<bool, 3> fixed{ true, true, true };
  double within = -1;  ///< displacement only, as for constraints
  double ramp = 0;     ///< [s]
  Region crop;
  int line = 0;
};

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
    selective  ///< voxels with one of `materials` get mass until they no longer rule the time step
  };
  Kind kind = Kind::none;
  double factor = 1;
  std::vector<std::string> materials;
};

/// One named setting of accuracy against time.
struct AccuracyProfile
{
  std::string name;
  Vector3 voxel{ 1e-3, 1e-3, 1e-3 };  ///< voxel edges [m]
  int samples = 4;                    ///< samples a voxel edge in boundary voxels
  double fill_min = 0.2;              ///< a voxel with less tissue than this proportion is dropped
  double time_step_share = 0.9;       ///< share of the critical time step that is used
  MassScaling mass_scaling;
  bool assumed_strain = false;  ///< hourglass control: assumed strain instead of one stiffness a voxel
};

/// Time settings.
struct SceneTime
{
  double damping = 0;      ///< mass-proportional damping coefficient [1/s]
  double scaling = 1;      ///< time scaling: the motion is played this many times faster in simulated time
  double frame_rate = 30;  ///< published skins a wall second [1/s]
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
  SceneTime time;
  AccuracyProfile accuracy;  ///< the profile chosen
  std::vector<AccuracyProfile> profiles;
  std::map<std::string, std::map<std::string, double>> expressions;  ///< preset -> muscle -> activation 0..1
  std::vector<DemoPhase> demo;
  std::string content;  ///< everything that decides the bake, canonical text: file contents hashed in, for caching
};

}  // namespace frontalis
