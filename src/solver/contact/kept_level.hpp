#pragma once

#include "frontalis/physics/distance_field.hpp"
#include "frontalis/physics/sliding.hpp"

namespace frontalis
{

/// The level set of a field on which a sliding node stays.
struct KeptLevel
{
  const physics::DistanceField* field;
  double level;  ///< [m]

  /// Finds the tangent plane of the level set near p, in the surface's frame. Returns false, and leaves `plane`
  /// unchanged, where no samples are stored or the gradient is too short; the node then keeps its latest tangent plane.
  bool plane_at(const physics::Vec3<double>& p, physics::LevelPlane<double>& plane) const
  {
    physics::FieldValue<double> value;
    return sample(*field, field_point(*field, p), value) && level_plane(value, level, plane);
  }
};

}  // namespace frontalis
