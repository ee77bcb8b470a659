#pragma once

#include "cuda/kernels/bound_points.hpp"

namespace frontalis
{

/// The part of the shells that a patch computes: the vertices in its voxels, whose forces it needs, all triangles
/// around these vertices, and the other vertices of these triangles. The vertices in its voxels come first, sorted by
/// voxel. The table of a patch has words of 16 bytes, in this order:
/// - for each vertex, its coordinates in its voxel; a fourth number, whose low 20 bits are the first four terms of the
/// force on the vertex and whose other bits are the number of fours;
/// - for each vertex, indices of the corners of its voxel in shared memory, 16 bits each;
/// - for each voxel with vertices, in half a word: the voxel's index in the patch; then its first vertex in 16 bits and
/// its number of vertices in the next 16 bits;
/// - for each term, in 16 bits, the position of the x component of a triangle's force on the vertex, or of a zero that
/// fills up a four;
/// - the triangles: see ShellTriangles.
struct alignas(8) PatchShell
{
  /// first word in ShellArguments::tables; number of words without the triangles
  std::uint32_t table_begin, table_words;
  std::uint32_t vertices, own, voxels, triangles;  ///< own: number of vertices in the patch's voxels
};

/// Words per triangle: physics::ShellTriangle, the bound of the bending stiffness [N/m], an unused number, the six
/// vertices, two unused numbers. Triangles are stored as [word][triangle], forces as [vertex][component][triangle]; in
/// patches a zero ends each row of forces.
constexpr int shell_words = 10;
struct ShellTriangles
{
  const float4* words;
  std::uint32_t count;
  bool spring;  ///< whether the forces are those of ShellStiffness
};

/// Shells in patches. Pointers are to device memory.
struct ShellArguments
{
  const PatchShell* patches;  ///< null: shells are not computed
  const uint4* tables;
  bool spring;  ///< see ShellTriangles
};

}  // namespace frontalis
