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

/// Rigid map from local coordinates to another frame: p = rotation * local + translation; rotation row by row.
struct RigidTransform
{
  std::array<double, 9> rotation{ { 1, 0, 0, 0, 1, 0, 0, 0, 1 } };
  std::array<double, 3> translation{ { 0, 0, 0 } };  ///< [m]
};

}  // namespace frontalis
