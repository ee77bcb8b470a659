#pragma once

#include "frontalis/physics/number.hpp"

namespace frontalis
{
namespace physics
{

/// Pose of a bone: maps points from the bone's frame to the scene's.
struct Pose
{
  using Point = Vec3<double>;

  double r[9] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };  ///< rotation, row by row
  double t[3] = { 0, 0, 0 };                    ///< translation [m]

  FRONTALIS_LAW Point turned(const Point& p) const
  {
    return { r[0] * p.x + r[1] * p.y + r[2] * p.z, r[3] * p.x + r[4] * p.y + r[5] * p.z,
             r[6] * p.x + r[7] * p.y + r[8] * p.z };
  }
  FRONTALIS_LAW Point turned_back(const Point& p) const
  {
    return { r[0] * p.x + r[3] * p.y + r[6] * p.z, r[1] * p.x + r[4] * p.y + r[7] * p.z,
             r[2] * p.x + r[5] * p.y + r[8] * p.z };
  }
  FRONTALIS_LAW Point outwards(const Point& p) const { return turned(p) + Point{ t[0], t[1], t[2] }; }
  FRONTALIS_LAW Point inwards(const Point& p) const { return turned_back(p - Point{ t[0], t[1], t[2] }); }
};

}  // namespace physics
}  // namespace frontalis
