#pragma once

#include <array>
#include <cstdint>

namespace frontalis
{

/// Number of vertices, or of pairs, that are processed together, one per lane.
constexpr int touch_width = 16;

/// Vertices of surfaces that touch each other, and how they follow the nodes of their voxels. Lanes beyond the last
/// vertex are copies of the first one.
template <class Real>
struct VertexBlock
{
  std::int32_t node[4][touch_width];   ///< the voxel's corners 0, 2, 4 and 6; the next node is the next corner
  std::int32_t bound[4][touch_width];  ///< the same, counted over the nodes that vertices are bound to
  Real coordinates[3][touch_width];    ///< in the voxel
  Real tangent[2][3][touch_width];     ///< at rest
  std::int32_t plane[touch_width];     ///< plane of the vertex's voxel; -2: the lane is empty
  Real inverse_spacing[3];             ///< of the grid [1/m]
};

/// Vertices in motion. Vectors that are gathered are records of four numbers.
template <class Real>
struct MovedVertices
{
  static constexpr std::ptrdiff_t stride = 8;

  Real* record;  ///< displacement [m] and normal
  Real* change;  ///< change of the displacement in the latest step [m]; null without friction
  /// Dual vectors of a vertex's tangents: the change of the normal is minus the sum over both tangents of their dual
  /// times (normal . change of the tangent). [block][6][lane]
  Real* dual;
};

/// The numbers of vertices and triangles of pairs of a vertex and a triangle of another surface, one pair per lane.
/// They stand apart from PairBlock because adding up forces needs them alone.
struct PairVertices
{
  std::int32_t vertex[4][touch_width];  ///< the point, and the triangle's corners
  std::int32_t triangle[touch_width];   ///< -1: none
};
/// The other numbers of these pairs (physics/surface_touch.hpp). Lanes beyond the last pair are copies of the first one
/// without stiffness.
template <class Real>
struct PairBlock
{
  Real rest[3][3][touch_width];  ///< at rest, from corner 0: the point, corners 1 and 2 [m]
  Real stiffness[touch_width], softer[3][touch_width], inner[3][touch_width];
  Real overlap[touch_width], friction[touch_width];
  // state
  Real held[touch_width];  ///< physics::PairGrip::stiffness
  Real pressed[touch_width], along[touch_width], stretch[3][touch_width];
};

/// Forces of pairs on the triangle's corners [N] and on the corners' normals (physics::corner_turn) [N m]. The force on
/// the point is minus the sum of the former. The record of lane l begins at number record[l] of its list
/// (TouchKernels).
template <class Real>
struct PairForceBlock
{
  Real corner[3][4 * touch_width], turn[3][4 * touch_width];
  Real stored[touch_width], lost[touch_width];  // [J]
};

/// Plain pointers, for the reason given at CpuKernelArguments.
template <class Real>
struct PairArguments
{
  const PairVertices* pair_vertices;
  PairBlock<Real>* pairs;
  PairForceBlock<Real>* forces;
  double* due;             ///< per block, the value of `way` at which its pairs are evaluated again [m]
  std::uint32_t* touches;  ///< bits of the lanes that touch, and bit touch_width if friction has lost energy
  MovedVertices<Real> vertices;
  double way;  ///< bound of how much closer a vertex and a triangle can have come to each other [m]
  Real response;
  Real deepest;   ///< depth to which points are held [m]
  Real patience;  ///< motion after which a pair behind its triangle that does not touch is checked again [m]
  bool rubs;      ///< whether there is friction
  /// Lets a pair whose foot lies beyond its triangle's edge go on to the triangle there.
  void (*go_on)(void* context, std::int32_t block, int lane);
  void* context;
};

template <class Real>
struct TouchKernels
{
  /// Places vertices of blocks [first, last) at the displacements u of nodes.
  void (*place)(const VertexBlock<Real>* blocks, const MovedVertices<Real>& vertices,
                const std::array<const Real*, 3>& u, std::int32_t first, std::int32_t last);
  /// Finds the forces of the pairs in those of the blocks [first, last) for which `due` is reached.
  void (*touch)(const PairArguments<Real>& arguments, std::int32_t first, std::int32_t last);
  /// Adds forces of vertices of a block to those of bound nodes in planes [first_plane, end_plane), which are records.
  /// `sums`: force on each vertex and on its normal; set to 0 afterwards.
  void (*spread)(const VertexBlock<Real>* blocks, const MovedVertices<Real>& vertices, Real* sums, Real* node_forces,
                 std::int32_t block, std::int32_t first_plane, std::int32_t end_plane);
  std::array<std::int32_t, touch_width> record;
};

/// The kernels without SIMD, in any precision.
template <class Real>
TouchKernels<Real> plain_touch_kernels();

}  // namespace frontalis
