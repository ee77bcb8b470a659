#pragma once

#include "frontalis/physics/sliding.hpp"

namespace frontalis
{
namespace physics
{

/// The field of a surface, linearised at a place in the surface's frame. Zeros: not found yet.
template <class T>
struct KeptLevel
{
  Vec3<T> gradient, place;
  T level;         ///< value of the field at `place` [m]
  T slip_squared;  ///< squared distance from `place` over which the plane is valid [m2]

  FRONTALIS_LAW bool covers(const Vec3<T>& p) const
  {
    const Vec3<T> way = p - place;
    return dot(way, way) < slip_squared;
  }
  FRONTALIS_LAW T level_at(const Vec3<T>& p) const { return level + dot(gradient, p - place); }
};

/// Linearises a field whose value at `place` is given. Keeps `level` as it is if the gradient is too short.
template <class T>
FRONTALIS_LAW void renew_level(const FieldValue<T>& value, const Vec3<T>& place, KeptLevel<T>& level)
{
  LevelPlane<T> plane{};
  if (level_plane(value, Number<T>::of(0), plane))
    level = { value.gradient, place, value.value, plane.slip * plane.slip };
}

/// A node's level on a surface that may move.
template <class T>
struct MovingLevel
{
  Vec3<T> gradient;          ///< in the scene's axes
  Vec3<T> surface_velocity;  ///< of the surface at the node [m/s]
  T level;                   ///< [m]
};

/// Displacement and velocity of a node or of a point of a bone.
template <class T>
struct PointMotion
{
  Vec3<T> u, v;
};

/// Equation for the change of a master's velocity, mass * change = momentum, with sums over its group.
template <class T>
struct Balance
{
  T mass[3][3] = {};
  T momentum[3] = {};

  FRONTALIS_LAW void add(const T& m, const Vec3<T>& push)
  {
    for (int axis = 0; axis < 3; ++axis)
      mass[axis][axis] = mass[axis][axis] + m;
    momentum[0] = momentum[0] + push.x;
    momentum[1] = momentum[1] + push.y;
    momentum[2] = momentum[2] + push.z;
  }
  /// Adds a mass that follows the master along one direction only, where it has this speed in excess.
  FRONTALIS_LAW void add(const T& m, const Vec3<T>& direction, const T& speed)
  {
    const T d[3] = { direction.x, direction.y, direction.z };
    for (int i = 0; i < 3; ++i)
    {
      momentum[i] = momentum[i] + m * speed * d[i];
      for (int j = 0; j < 3; ++j)
        mass[i][j] = mass[i][j] + m * d[i] * d[j];
    }
  }
  FRONTALIS_LAW void fix(int axis)
  {
    for (int i = 0; i < 3; ++i)
      mass[i][axis] = mass[axis][i] = T(0);
    mass[axis][axis] = T(1);
    momentum[axis] = T(0);
  }
  /// Solves the equation by elimination; the matrix is symmetric and positive definite.
  FRONTALIS_LAW Vec3<T> change()
  {
    T inverse[3];
    FRONTALIS_UNROLL
    for (int p = 0; p < 3; ++p)
    {
      inverse[p] = T(1) / mass[p][p];
      for (int i = p + 1; i < 3; ++i)
      {
        const T factor = mass[i][p] * inverse[p];
        for (int j = p; j < 3; ++j)
          mass[i][j] = mass[i][j] - factor * mass[p][j];
        momentum[i] = momentum[i] - factor * momentum[p];
      }
    }
    FRONTALIS_UNROLL
    for (int p = 2; p >= 0; --p)
    {
      for (int j = p + 1; j < 3; ++j)
        momentum[p] = momentum[p] - mass[p][j] * momentum[j];
      momentum[p] = momentum[p] * inverse[p];
    }
    return { momentum[0], momentum[1], momentum[2] };
  }
};

}  // namespace physics
}  // namespace frontalis
