#pragma once

#include "cuda/kernels/bound_points.hpp"

namespace frontalis
{

/// The part of the shells that a patch computes: vertices in its voxels, on which it needs the forces, all triangles
/// around them, and the other vertices of these triangles. Vertices in its voxels come first, sorted by voxel. The
/// table of a patch has words of 16 bytes, in this order:
/// - for each vertex, its coordinates in its voxel; the bits of the fourth number are the first term of the force on
///   it, and from bit 20 on the number of terms;
/// - for each vertex, where shared memory has the corners of its voxel, in 16 bits each;
/// - for each voxel with vertices, in half a word: its number in the patch; its first vertex, and from bit 16 on their
///   number;
/// - for each term, in 16 bits, where the x component of a triangle's force on the vertex is;
/// - the triangles: see ShellTriangles.
struct alignas(8) PatchShell
{
  std::uint32_t table_begin, table_words;  ///< into ShellArguments::tables; number of words without the triangles
  std::uint32_t vertices, voxels, triangles, unused;
};

/// Words per triangle: physics::ShellTriangle, the bound of the bending stiffness [N/m], an unused number, the six
/// vertices, two unused numbers. They are stored as [word][triangle]; forces, as [vertex][component][triangle].
constexpr int shell_words = 10;
struct ShellTriangles
{
  const float4* words;
  std::uint32_t count;
  bool spring;  ///< forces are those of ShellStiffness::add_forces()
};

/// Layers that are shells, in patches.
struct ShellArguments
{
  const PatchShell* patches;  ///< null: shells are not computed
  const uint4* tables;
  bool spring;  ///< see ShellTriangles
};

}  // namespace frontalis
