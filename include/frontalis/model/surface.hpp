#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace frontalis
{

/// Triangulated surface in local coordinates [m].
struct TriangleMesh
{
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<std::int32_t, 3>> triangles;
};

/// Points tied to voxels: they follow by trilinear interpolation (or extrapolation) of the voxel's eight nodes.
struct Binding
{
  std::vector<std::int32_t> voxel;                ///< index into Model::voxels
  std::vector<std::array<float, 3>> coordinates;  ///< in the voxel, 0..1 inside, along x, y, z
};

/// Rigid map from local coordinates to another frame.
struct RigidTransform
{
  std::array<double, 9> rotation{ { 1, 0, 0, 0, 1, 0, 0, 0, 1 } };  ///< row by row
  std::array<double, 3> translation{ { 0, 0, 0 } };                 ///< [m]

  bool operator==(const RigidTransform& other) const
  {
    return rotation == other.rotation && translation == other.translation;
  }
  bool operator!=(const RigidTransform& other) const { return !(*this == other); }

  /// Applies the rotation to a vector.
  template <class Number>
  std::array<double, 3> turned(const std::array<Number, 3>& v) const
  {
    const auto row = [&](std::size_t i)
    { return rotation[i] * v[0] + rotation[i + 1] * v[1] + rotation[i + 2] * v[2]; };
    return { { row(0), row(3), row(6) } };
  }
  /// Applies the map to a point [m].
  template <class Number>
  std::array<double, 3> operator()(const std::array<Number, 3>& p) const
  {
    const auto t = turned(p);
    return { { t[0] + translation[0], t[1] + translation[1], t[2] + translation[2] } };
  }
};

}  // namespace frontalis
