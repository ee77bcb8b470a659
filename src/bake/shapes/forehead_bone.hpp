#pragma once

#include "frontalis/bake/forehead_shape.hpp"
#include "bake/vector.hpp"

namespace frontalis
{

/// The generated forehead as a map from (s, z, depth) to space. s is the arc length from the midline, positive to the
/// subject's left [m], z the height above the sellion [m], depth a proportion of the soft tissue: 0 at the skin, 1 at
/// the bone.
class ForeheadMap
{
public:
  explicit ForeheadMap(const ForeheadDimensions& dimensions);

  const ForeheadDimensions& dimensions() const { return dimensions_; }
  Vector3d at(double s, double z, double depth) const;
  /// Of the soft tissue [m].
  double thickness(double z) const;

  /// Heights of the edges: the orbital rim, lower at the nasal root, and the hairline, lower at the temples [m].
  double lower_edge(double s) const;
  double upper_edge(double s) const;
  double half_width() const { return 0.5 * dimensions_.width; }

private:
  Vector3d bone(double s, double z) const;

  ForeheadDimensions dimensions_;
  double depth_axis_;  ///< semi-axis of the horizontal section along x [m]
  double shift_ = 0;   ///< along x, puts the sellion on the skin at the origin [m]
};

}  // namespace frontalis
