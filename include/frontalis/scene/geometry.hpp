#pragma once

#include <array>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace frontalis
{

using Vector3 = std::array<double, 3>;

struct HeadTemplate;
struct Surface;

/// Axis-aligned box in scene coordinates [m]. By default all sides lie at infinity.
struct Region
{
  Vector3 lower{ -std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
                 -std::numeric_limits<double>::infinity() };
  Vector3 upper{ std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                 std::numeric_limits<double>::infinity() };
};

/// A built-in surface. Each kind uses `edge` and the fields named beside it. Lengths are in metres.
struct Shape
{
  enum class Kind
  {
    box,        ///< centre, size (full edge lengths)
    sphere,     ///< centre, radius
    ellipsoid,  ///< centre, size (semi-axes)
    cylinder,   ///< centre, axis, radius, length; closed by caps
    torus,      ///< centre, axis, radius (of the ring), minor_radius (of the tube)
    forehead,   ///< part (one of forehead_parts()), dimensions
    head,       ///< head, part (one of its parts()), dimensions, tissue
    muscle,     ///< curves, ring, thickness
    offset      ///< below, depths
  };
  Kind kind = Kind::box;
  Vector3 centre{ 0, 0, 0 };
  Vector3 size{ 0, 0, 0 };
  Vector3 axis{ 0, 0, 1 };
  double radius = 0;
  double minor_radius = 0;
  double length = 0;
  double edge = 0;   ///< target edge length of the triangles [m]; 0: chosen from the size, or default_edge
  std::string part;  ///< name of the part (forehead and head only)
  std::shared_ptr<const HeadTemplate> head;
  /// Dimensions of the generated forehead or head [m] by name; dimensions that are not given have their defaults.
  std::map<std::string, double> dimensions;
  double tissue = 1;  ///< head: factor on the template's depths of the bone below the skin
  /// Muscle: lines across its fibres, from the origin to the insertion; ring: loops, from the inner to the outer [m].
  std::vector<std::vector<Vector3>> curves;
  bool ring = false;
  double thickness = 0;                  ///< of a muscle's middle [m]; 0: an open sheet
  std::shared_ptr<const Surface> below;  ///< the closed surface from which depths are measured
  struct Depth
  {
    Vector3 at{ 0, 0, 0 };  ///< a place near that surface [m]
    double depth = 0;       ///< [m]
  };
  std::vector<Depth> depths;  ///< values between and beyond these places are interpolated

  static constexpr double default_edge = 1.75e-3;  ///< of forehead, head, muscle and offset [m]
  double edge_or_default() const { return edge > 0 ? edge : default_edge; }
};

struct Surface
{
  std::string name;
  std::string file;            ///< path, relative to the mesh directory or the scene's folder; empty for a shape
  std::optional<Shape> shape;  ///< set if `file` is empty
  double unit = 1;             ///< metres per unit of the mesh (files only)
  int subdivide = 0;           ///< steps of Catmull-Clark subdivision (files only)
  int mirror = -1;             ///< axis across which the file's mirror image is added; -1: none
  int line = 0;                ///< line in the scene file, for messages of the bake
};

/// The set of points that meet all of these conditions; a condition with an empty field does not apply. The point lies
/// inside the surface formed by all of `closed_by`, inside at least one of `inside`, outside all of `outside` and
/// `without`, inside `crop`, and depth_min to depth_max [m] below `within` (negative: above it), with none of `outside`
/// in between.
struct Volume
{
  std::string name;
  std::vector<std::string> closed_by;
  std::vector<std::string> inside;
  std::vector<std::string> outside;
  std::vector<std::string> without;
  std::vector<std::string> slits;  ///< surfaces, open or closed, at which the tissue is cut
  std::string within;
  double depth_min = 0;
  double depth_max = 0;
  Region crop;
  std::string material;  ///< empty: the volume does not change the material of the tissue
  int priority = 0;      ///< where volumes overlap, the highest priority wins; equal priorities share the space
  bool tissue = false;   ///< voxels are made in tissue volumes only; other volumes change their material or add fibres
  int line = 0;
};

/// Parts of the generated forehead. Open surfaces: `skin` and `skull`, which face outwards, and `rim`, which joins the
/// edges of skin and bone, with its pieces `rim_upper`, `rim_lower` and `rim_lateral`. Closed surfaces: `tissue` (skin,
/// rim and the bone below the skin), the muscles `frontalis_left`, `frontalis_right`, `corrugator_left`,
/// `corrugator_right` and `procerus`, and the tendon sheet `galea`.
const std::vector<std::string>& forehead_parts();

}  // namespace frontalis
