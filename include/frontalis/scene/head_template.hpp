#pragma once

#include "frontalis/scene/geometry.hpp"

#include <memory>
#include <utility>

namespace frontalis
{

/// The parametric head as data: what the YAML files of a template say (doc/head.md). Positions are those of the default
/// head in the face frame [m]; sided data are of the left side and are mirrored at y = 0.
struct HeadTemplate
{
  struct Dimension
  {
    std::string name;
    std::string from, to;            ///< landmarks; `to` empty: from the left `from` to the right one
    double mean = 0, deviation = 0;  ///< midpoint of the published means of men and women, and their deviation [m]
    double men = 0, women = 0;       ///< these means [m]
    std::vector<std::string> derived_from;  ///< the dimensions that it follows from; empty: it may be set alone
  };
  /// A place on the skin below which the bone lies at a known depth.
  struct DepthSite
  {
    std::string name;
    Vector3 at{ 0, 0, 0 };         ///< the closest point of the skin is taken
    double depth = 0;              ///< [m]
    Vector3 direction{ 0, 0, 0 };  ///< into the head; 0: against the skin's normal
  };
  /// A solid of which bones are built. Those about the midline are symmetric; all are mirrored at y = 0.
  struct Solid
  {
    enum class Kind
    {
      below,      ///< `depth` or more below the hull, which is the bones' outer surface
      above,      ///< less than `depth` below the hull
      ellipsoid,  ///< centre, axes (semi-axes)
      outline,    ///< closed curve through `points` in the plane across `axis`, from `from` to `to` along it; with
                  ///< `depth` a cone: the curve stands `depth` from the apex `centre`
      tube,       ///< round a curve through `points` with the radii `sizes`
      teeth       ///< along a curve through `points` from the midline; edges at z = `to`, necks at `from`;
                  ///< `sizes`: width, thickness at the edge and at the neck of each tooth
    };
    Kind kind = Kind::below;
    double depth = 0;
    Vector3 centre{ 0, 0, 0 }, axes{ 0, 0, 0 };
    int axis = 0;
    double from = -std::numeric_limits<double>::infinity(), to = std::numeric_limits<double>::infinity();
    std::vector<Vector3> points;  ///< of an outline: the two coordinates that are not `axis`, and 0
    std::vector<Vector3> sizes;   ///< [m]
  };
  /// One step of building a bone: what all `solids` share is added to it, cut from it, or all that is left of it.
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
    double round = 0;  ///< radius of the edges that it makes [m]
  };
  /// A line across a muscle: positions near the skin, and its depth.
  struct Curve
  {
    std::vector<Vector3> points;
    double depth = 0.5;  ///< as a proportion of the soft tissue (1: the bone)
    double below = -1;   ///< of its middle [m], in place of `depth`, also past a bone; < 0: `depth` holds
  };
  /// A muscle between its first and last curve, or around loops from its inner to its outer one; or a fat pad.
  struct Muscle
  {
    std::string name;
    bool sided = true;  ///< a left and a right one
    bool ring = false;
    bool pad = false;  ///< a fat pad
    std::vector<Curve> curves;
    double thickness = 0;  ///< [m]
  };

  /// How a bone turns by one angle: about an axis that slides in proportion to the angle.
  struct Joint
  {
    Vector3 at{ 0, 0, 0 }, axis{ 0, 0, 1 };  ///< a point of the axis [m], and its direction
    Vector3 slide{ 0, 0, 0 };                ///< per angle [m/rad]
  };
  /// A named place on the skin: a vertex of the cage if `vertex` is at least 0, else the point of the skin closest to
  /// `at`; `right`: its mirror image.
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
  std::map<std::string, int> landmarks;              ///< index of a vertex of the cage
  std::map<std::string, std::vector<Point>> points;  ///< sets of landmarks: `anthropometric` and those of the files
  std::map<std::string, Joint> joints;               ///< by bone
  std::vector<Dimension> dimensions;
  /// Presets: what an age adds to each dimension [m], and by how much tissue is thicker than normal.
  std::map<std::string, std::map<std::string, double>> ages;
  std::map<std::string, double> tissues;
  std::vector<DepthSite> depths;
  using Built = std::vector<std::pair<std::string, std::vector<BoneStep>>>;
  Built bones;
  Built bodies;  ///< made as bones are, but no bone below the soft tissue: what lips rest on and what parts them
  std::vector<Muscle> muscles;
  Vector3 eye{ 0, 0, 0 };  ///< centre of the left eyeball [m]
  double eye_radius = 0;   ///< [m]

  /// Names of the surfaces that can be made: skin, bones, bodies, eyeballs and muscles.
  std::vector<std::string> parts() const;
  std::vector<std::string> muscle_parts(bool pads = false) const;  ///< those that are muscles, or the fat pads
};

/// Reads a template and the files that it names. Throws Error with one line per fault.
std::shared_ptr<const HeadTemplate> read_head_template(const std::string& path);

}  // namespace frontalis
