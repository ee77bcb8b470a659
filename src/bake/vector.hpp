#pragma once

#include "frontalis/scene/scene.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{

// double-precision vectors of the bake: three components, scene units (metres)

inline Vector3 operator+(const Vector3& a, const Vector3& b) { return { a[0] + b[0], a[1] + b[1], a[2] + b[2] }; }
inline Vector3 operator-(const Vector3& a, const Vector3& b) { return { a[0] - b[0], a[1] - b[1], a[2] - b[2] }; }
inline Vector3 operator*(double s, const Vector3& a) { return { s * a[0], s * a[1], s * a[2] }; }
inline double dot(const Vector3& a, const Vector3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vector3 cross(const Vector3& a, const Vector3& b)
{
  return { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
}
inline double norm(const Vector3& a) { return std::sqrt(dot(a, a)); }
/// Unit vector; a vector of length 0 stays as it is.
inline Vector3 normalised(const Vector3& a)
{
  const double length = norm(a);
  return length > 0 ? (1 / length) * a : a;
}
inline bool is_finite(const Vector3& a) { return std::isfinite(a[0]) && std::isfinite(a[1]) && std::isfinite(a[2]); }

/// Axis-aligned box; empty where lower exceeds upper.
struct Box
{
  Vector3 lower{ 1e300, 1e300, 1e300 };
  Vector3 upper{ -1e300, -1e300, -1e300 };

  void include(const Vector3& p)
  {
    for (std::size_t a = 0; a < 3; ++a)
    {
      lower[a] = std::min(lower[a], p[a]);
      upper[a] = std::max(upper[a], p[a]);
    }
  }
  void include(const Box& other)
  {
    for (std::size_t a = 0; a < 3; ++a)
    {
      lower[a] = std::min(lower[a], other.lower[a]);
      upper[a] = std::max(upper[a], other.upper[a]);
    }
  }
  void intersect(const Region& region)
  {
    for (std::size_t a = 0; a < 3; ++a)
    {
      lower[a] = std::max(lower[a], region.lower[a]);
      upper[a] = std::min(upper[a], region.upper[a]);
    }
  }
  bool empty() const { return lower[0] > upper[0] || lower[1] > upper[1] || lower[2] > upper[2]; }
  bool overlaps(const Box& other) const
  {
    for (std::size_t a = 0; a < 3; ++a)
    {
      if (lower[a] > other.upper[a] || upper[a] < other.lower[a])
        return false;
    }
    return true;
  }
  Vector3 centre() const { return 0.5 * (lower + upper); }
  double squared_distance(const Vector3& p) const
  {
    double sum = 0;
    for (std::size_t a = 0; a < 3; ++a)
    {
      const double d = std::max({ lower[a] - p[a], 0.0, p[a] - upper[a] });
      sum += d * d;
    }
    return sum;
  }
};

inline bool contains(const Region& region, const Vector3& p)
{
  for (std::size_t a = 0; a < 3; ++a)
  {
    if (p[a] < region.lower[a] || p[a] > region.upper[a])
      return false;
  }
  return true;
}

}  // namespace frontalis
