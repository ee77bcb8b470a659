#pragma once

#include "frontalis/physics/distance_field.hpp"
#include "frontalis/physics/sliding.hpp"

namespace frontalis
{

/// The level set of a field that a sliding node keeps to.
struct KeptLevel
{
  const physics::DistanceField* field;
  double level;  ///< [m]

  /// Tangent plane near p, in the surface's frame. Returns false, and leaves `plane` as it is, where the field ends or
  /// has no direction: the node keeps the plane that it has.
  bool plane_at(const physics::Vec3<double>& p, physics::LevelPlane<double>& plane) const
  {
    physics::FieldValue<double> value;
    return sample(*field, field_point(*field, p), value) && level_plane(value, level, plane);
  }
};

}  // namespace frontalis
