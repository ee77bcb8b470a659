#pragma once

#include "cuda/kernels/bound_points.hpp"

namespace frontalis
{

/// The part of the shells that a patch computes: vertices in its voxels, whose forces it needs, all triangles around
/// them, and the other vertices of these. In strips there is one such part, of everything.
struct alignas(8) PatchShell
{
  std::uint32_t vertex_begin, vertices;     ///< those in its voxels come first, sorted by voxel
  std::uint32_t triangle_begin, triangles;  ///< into ShellArguments::triangles
  std::uint32_t voxel_begin, voxels;        ///< those with vertices: into ShellArguments::voxels
};

/// Words of 16 bytes per triangle: physics::ShellTriangle, the bound of the bending stiffness [N/m], an unused number,
/// the six vertices in its patch, two unused numbers.
constexpr int shell_words = 10;

/// Layers that are shells, in device memory. A patch keeps displacements of its vertices, and forces as
/// [vertex of the triangle][component][triangle].
struct ShellArguments
{
  const PatchShell* patches;   ///< null: shells are not computed
  const uint4* corners;        ///< two per vertex: corners of its voxel in the block's shared memory, or device nodes
  const float4* coordinates;   ///< of each vertex in its voxel
  const uint2* sums;           ///< of each vertex, terms of the force on it: first and number
  const std::uint32_t* terms;  ///< where a patch keeps the x components of these forces
  const float4* triangles;     ///< [word][triangle]
  std::uint32_t triangle_count;
  const BoundVoxel* voxels;
  /// Forces are those of ShellStiffness::add_forces().
  bool spring;
};

}  // namespace frontalis
