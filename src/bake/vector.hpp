#pragma once

#include "frontalis/scene/geometry.hpp"

#include <Eigen/Geometry>

namespace frontalis
{

// The bake computes with Eigen's vectors and boxes [m]; scenes and models hold plain arrays.
using Eigen::Vector3d;
using Box = Eigen::AlignedBox3d;

constexpr double pi = 3.14159265358979323846;

inline Vector3d to_vector(const Vector3& a) { return { a[0], a[1], a[2] }; }
inline Vector3 to_array(const Vector3d& v) { return { v[0], v[1], v[2] }; }
inline Box to_box(const Region& region) { return { to_vector(region.lower), to_vector(region.upper) }; }

}  // namespace frontalis
