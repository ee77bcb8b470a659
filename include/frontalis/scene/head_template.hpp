#pragma once

#include "frontalis/scene/geometry.hpp"

#include <memory>
#include <utility>

namespace frontalis
{

/// The parametric head as data: the contents of a template's YAML files (doc/head.md). Positions are those of the
/// default head in the face frame [m]. Parts with two sides have the data of the left one, which are mirrored at y = 0.
struct HeadTemplate
{
  struct Dimension
  {
    std::string name;
    std::string from, to;                   ///< landmarks; `to` empty: from the left landmark `from` to the right one
    double mean = 0, deviation = 0;         ///< midpoint of `men` and `women`, and the standard deviation [m]
    double men = 0, women = 0;              ///< published means [m]
    std::vector<std::string> derived_from;  ///< dimensions that determine this one; empty: it may be set by itself
  };
  /// A place on the skin below which the bone lies at a known depth.
  struct DepthSite
  {
    std::string name;
    Vector3 at{ 0, 0, 0 };         ///< the place is the closest point of the skin
    double depth = 0;              ///< [m]
    Vector3 direction{ 0, 0, 0 };  ///< direction of the depth, into the head; 0: against the skin's normal
  };
  /// A solid from which bones are built. Solids across the midline are symmetric; bones are mirrored at y = 0.
  struct Solid
  {
    enum class Kind
    {
      below,      ///< all that is `depth` or more below the hull, the common outer surface of the bones
      above,      ///< all that is less than `depth` below the hull, or outside it
      ellipsoid,  ///< centre, axes (semi-axes)
      outline,    ///< closed curve through `points` in the plane across `axis`, from `from` to `to` along it; with
                  ///< `depth` a cone: the curve stands `depth` from the apex `centre`
      tube,       ///< tube round a curve through `points` with the radii `sizes`
      teeth       ///< row along a curve through `points` from the midline; edges at z = `to`, necks at z = `from`;
                  ///< `sizes`: width, thickness at the edge and at the neck of each tooth
    };
    Kind kind = Kind::below;
    double depth = 0;
    Vector3 centre{ 0, 0, 0 }, axes{ 0, 0, 0 };
    int axis = 0;
    double from = -std::numeric_limits<double>::infinity(), to = std::numeric_limits<double>::infinity();
    std::vector<Vector3> points;  ///< for an outline: the coordinates other than `axis`, and 0
    std::vector<Vector3> sizes;   ///< [m]
  };
  /// One step of building a bone: the intersection of `solids` is added to it, cut from it, or intersected with it.
  struct BoneStep
  {
    enum class Kind
    {
      add,
      cut,
      keep
    };
    Kind kind = Kind::add;
    std::vector<Solid> solids;
    double round = 0;  ///< radius of the edges that the step makes [m]
  };
  /// A line across a muscle: positions near the skin, and the depth of the line below it.
  struct Curve
  {
    std::vector<Vector3> points;
    double depth = 0.5;  ///< depth as a proportion of the soft tissue (1: at the bone)
    double below = -1;   ///< depth of its middle [m], which may lie past a bone; < 0: `depth` applies
  };
  /// A muscle, or a fat pad, from its first to its last curve. With `ring` the curves are loops, from inner to outer.
  struct Muscle
  {
    std::string name;
    bool sided = true;  ///< whether there is one on each side
    bool ring = false;
    bool pad = false;  ///< whether it is a fat pad
    std::vector<Curve> curves;
    double thickness = 0;  ///< [m]
  };

  /// The rotation of a bone by one angle, about an axis that moves in proportion to the angle.
  struct Joint
  {
    Vector3 at{ 0, 0, 0 }, axis{ 0, 0, 1 };  ///< a point of the axis [m], and its direction
    Vector3 slide{ 0, 0, 0 };                ///< translation of the axis per angle [m/rad]
  };
  /// A named place on the skin: a vertex of the cage if `vertex` is at least 0, else the point of the skin closest to
  /// `at`. With `right` the place is the mirror image.
  struct Point
  {
    std::string name;
    int vertex = -1;
    Vector3 at{ 0, 0, 0 };  ///< [m]
    bool right = false;
  };

  std::string file;
  std::vector<std::string> files;                    ///< every file that the template consists of
  std::string cage;                                  ///< OBJ file of the left half of the skin's control cage
  double unit = 1;                                   ///< metres per unit of the cage
  std::map<std::string, int> landmarks;              ///< vertices of the cage, by the name of the landmark
  std::map<std::string, std::vector<Point>> points;  ///< sets of landmarks: `anthropometric` and those of the files
  std::map<std::string, Joint> joints;               ///< joints by the name of the bone
  std::vector<Dimension> dimensions;
  /// Presets: for each age the increase of dimensions [m], and for each amount of tissue the factor on its thickness.
  std::map<std::string, std::map<std::string, double>> ages;
  std::map<std::string, double> tissues;
  std::vector<DepthSite> depths;
  using Built = std::vector<std::pair<std::string, std::vector<BoneStep>>>;
  Built bones;
  Built bodies;  ///< built like bones, but not bone: they support the lips and keep them apart
  std::vector<Muscle> muscles;
  Vector3 eye{ 0, 0, 0 };  ///< centre of the left eyeball [m]
  double eye_radius = 0;   ///< [m]

  /// Names of the surfaces that can be made: skin, bones, bodies, eyeballs and muscles.
  std::vector<std::string> parts() const;
  std::vector<std::string> muscle_parts(bool pads = false) const;  ///< parts that are muscles, or fat pads
};

/// Reads a template and the files that it names. Throws Error with one line per fault.
std::shared_ptr<const HeadTemplate> read_head_template(const std::string& path);

}  // namespace frontalis
