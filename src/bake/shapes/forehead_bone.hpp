#pragma once

#include "frontalis/bake/forehead_shape.hpp"
#include "bake/vector.hpp"

namespace frontalis
{

/// The generated forehead as a map from (s, z, depth) to space: s is the lateral arc from the midline, positive to the
/// left [m], z the height over the sellion [m], depth a proportion of the soft tissue: 0 at the skin, 1 at the bone.
class ForeheadMap
{
public:
  explicit ForeheadMap(const ForeheadDimensions& dimensions);

  const ForeheadDimensions& dimensions() const { return dimensions_; }
  Vector3 at(double s, double z, double depth) const;
  double thickness(double z) const;

  /// Lower edge: the orbital rim, dipping to the nasal root in the midline. Upper edge: the hairline, lower at the
  /// temples.
  double lower_edge(double s) const;
  double upper_edge(double s) const;
  double half_width() const { return 0.5 * dimensions_.width; }

private:
  Vector3 bone(double s, double z) const;

  ForeheadDimensions dimensions_;
  double depth_axis_;  ///< semi-axis of the horizontal section along x [m]
  double shift_ = 0;   ///< along x, puts the sellion on the skin at the origin [m]
};

}  // namespace frontalis
