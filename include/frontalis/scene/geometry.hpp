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
  double unit = 1;             ///< metres per unit of the mesh (files only)
  int line = 0;                ///< line in the scene file, for messages of the bake
};

/// A set of points: inside the collection `closed_by` taken together (if given), inside at least one of `inside`
/// (if given), outside each of `outside` and of `without`, at a depth in [depth_min, depth_max] below the surface
/// `within` (if given) with none of the surfaces `outside` on the straight way there, and inside `crop`.
struct Volume
{
  std::string name;
  std::vector<std::string> closed_by;
  std::vector<std::string> inside;
  std::vector<std::string> outside;
  std::vector<std::string> without;
  std::string within;
  double depth_min = 0;
  double depth_max = 0;
  Region crop;
  std::string material;  ///< empty: the volume fills nothing and only bounds something
  int priority = 0;     ///< at a point in several volumes the highest priority wins; volumes of equal priority share it
  bool tissue = false;  ///< voxels are made where tissue volumes are; other volumes only change what fills them
  int line = 0;
};

/// Parts of the generated forehead: `skin`, `skull` (both face outwards; open sheets), `rim` (joins the edges of skin
/// and bone) and its pieces `rim_upper`, `rim_lower`, `rim_lateral`; `tissue` (closed: skin, rim and the bone below
/// them); the muscles `frontalis_left`, `frontalis_right`, `corrugator_left`, `corrugator_right`, `procerus` and the
/// tendon sheet `galea` (closed, following the curvature).
const std::vector<std::string>& forehead_parts();

}  // namespace frontalis
