#pragma once

#include "frontalis/scene/geometry.hpp"

#include <memory>

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
  /// A line across a muscle: positions near the skin, and its depth as a proportion of the soft tissue (1: the bone).
  struct Curve
  {
    std::vector<Vector3> points;
    double depth = 0.5;
  };
  /// A muscle between its first and last curve, or around loops from its inner to its outer one.
  struct Muscle
  {
    std::string name;
    bool sided = true;  ///< a left and a right one
    bool ring = false;
    std::vector<Curve> curves;
    double thickness = 0;  ///< [m]
  };

  std::string file;
  std::vector<std::string> files;        ///< every file that the template consists of
  std::string cage;                      ///< OBJ file of the left half of the skin's control cage
  double unit = 1;                       ///< metres per unit of the cage
  std::map<std::string, int> landmarks;  ///< index of a vertex of the cage
  std::vector<Dimension> dimensions;
  std::vector<DepthSite> depths;
  std::vector<Muscle> muscles;
  Vector3 eye{ 0, 0, 0 };  ///< centre of the left eyeball [m]
  double eye_radius = 0;   ///< [m]

  /// Names of the surfaces that can be made: skin, bones, eyeballs and muscles.
  std::vector<std::string> parts() const;
  std::vector<std::string> muscle_parts() const;  ///< those that are muscles
};

/// Reads a template and the files that it names. Throws Error with one line per fault.
std::shared_ptr<const HeadTemplate> read_head_template(const std::string& path);

}  // namespace frontalis
