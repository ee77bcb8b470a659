#pragma once

#include <array>
#include <cstdint>

namespace frontalis
{

/// Number of vertices, or of pairs, that are processed together, one per lane.
constexpr int touch_width = 16;

/// Vertices of surfaces that touch each other, and how they follow the nodes of their voxels. Lanes beyond the last
/// vertex are copies of the first vertex.
template <class Real>
struct VertexBlock
{
  /// corners 0, 2, 4 and 6 of the voxel; corners 1, 3, 5 and 7 are the nodes that follow them
  std::int32_t node[4][touch_width];
  std::int32_t bound[4][touch_width];  ///< the same corners, as indices among the nodes to which vertices are bound
  Real coordinates[3][touch_width];    ///< position in the voxel
  Real tangent[2][3][touch_width];     ///< tangents at rest
  std::int32_t plane[touch_width];     ///< plane of the vertex's voxel; -2: the lane is empty
  Real inverse_spacing[3];             ///< 1 over the spacing of the grid [1/m]
};

/// Present state of vertices. Vectors that are gathered are stored as records of four numbers.
template <class Real>
struct MovedVertices
{
  static constexpr std::ptrdiff_t stride = 8;

  Real* record;  ///< displacement [m] and normal
  Real* change;  ///< change of the displacement in the latest step [m]; null without friction
  /// Dual vectors of a vertex's two tangents, as [block][6][lane]: the normal changes by minus the sum, over both
  /// tangents, of the dual vector times (normal . change of the tangent).
  Real* dual;
};

/// The indices of vertices and triangles of pairs, one pair per lane. A pair is a vertex and a triangle of another
/// surface. These indices are not part of PairBlock, because adding up forces needs only them.
struct PairVertices
{
  std::int32_t vertex[4][touch_width];  ///< the pair's vertex, and the triangle's corners
  std::int32_t triangle[touch_width];   ///< -1: the lane has no pair
};
/// The other values of these pairs (physics/surface_touch.hpp). Lanes beyond the last pair are copies of the first pair
/// without stiffness.
template <class Real>
struct PairBlock
{
  /// positions of the pair's vertex and of corners 1 and 2 at rest, relative to corner 0 [m]
  Real rest[3][3][touch_width];
  Real stiffness[touch_width], softer[3][touch_width], inner[3][touch_width];
  Real overlap[touch_width], friction[touch_width];
  // State of friction:
  Real held[touch_width];  ///< physics::PairGrip::stiffness
  Real pressed[touch_width], along[touch_width], stretch[3][touch_width];
};

/// Forces of pairs on the triangle's corners [N] and on the corners' normals (physics::corner_turn) [N m]. The force on
/// the pair's vertex is minus the sum of the forces on the corners. The record of lane l begins at number record[l] of
/// its list (TouchKernels).
template <class Real>
struct PairForceBlock
{
  Real corner[3][4 * touch_width], turn[3][4 * touch_width];
  Real stored[touch_width], lost[touch_width];  // [J]
};

/// Arguments of the kernel: plain pointers, for the reason given at CpuKernelArguments.
template <class Real>
struct PairArguments
{
  const PairVertices* pair_vertices;
  PairBlock<Real>* pairs;
  PairForceBlock<Real>* forces;
  double* due;             ///< per block, the value of `way` at which its pairs are evaluated again [m]
  std::uint32_t* touches;  ///< bits of the lanes that touch, and bit touch_width if friction has lost energy
  MovedVertices<Real> vertices;
  double way;  ///< upper bound of the distance by which a vertex and a triangle have approached each other [m]
  Real response;
  Real deepest;  ///< largest depth behind a triangle at which a vertex still feels a force [m]
  /// motion after which a pair whose vertex is behind its triangle without touching it is checked again [m]
  Real patience;
  bool rubs;  ///< whether there is friction
  /// Called for a pair whose foot lies beyond an edge of its triangle: moves the pair to the triangle on the other
  /// side.
  void (*go_on)(void* context, std::int32_t block, int lane);
  void* context;
};

/// Balls around triangles, or around blocks of balls, one per lane (contact/touch_tree.hpp).
template <class Real>
struct BallBlock
{
  Real centre[3][touch_width];
  Real farthest[touch_width];  ///< square of the distance from the centre within which a vertex is near [m2]
  Real away[3][touch_width];   ///< a vertex is not near if the component of its normal along this vector is above 1
};
/// The triangles inside such balls.
template <class Real>
struct FacetBlock
{
  Real normal[3][touch_width];
  Real slope[2][3][touch_width];  ///< gradients of the barycentric coordinates of corners 1 and 2 [1/m]
  /// A vertex is near if each barycentric coordinate of its projection onto the facet is at least -beyond - lean *
  /// height above the facet, and the height is below `highest` [m].
  Real lean[3][touch_width], beyond[touch_width], highest[touch_width];
};

/// Boxes around the positions and displacements of groups of vertices, one group per lane. Empty lanes have boxes whose
/// lower corner is far above the upper one.
template <class Real>
struct GroupBoxes
{
  struct Boxes
  {
    Real least[3][touch_width], most[3][touch_width];  // [m]
  };
  Boxes place, way;
};

template <class Real>
struct TouchKernels
{
  /// Finds the positions of vertices of blocks [first, last) at the displacements u of nodes.
  void (*place)(const VertexBlock<Real>* blocks, const MovedVertices<Real>& vertices,
                const std::array<const Real*, 3>& u, std::int32_t first, std::int32_t last);
  /// Finds the forces of the pairs in the blocks of [first, last) whose value `due` is reached.
  void (*touch)(const PairArguments<Real>& arguments, std::int32_t first, std::int32_t last);
  /// Passes forces on vertices of a block on to bound nodes in planes [first_plane, end_plane). node_forces has a
  /// record per bound node. `sums`: force on each vertex and on its normal; they are set to 0 afterwards.
  void (*spread)(const VertexBlock<Real>* blocks, const MovedVertices<Real>& vertices, Real* sums, Real* node_forces,
                 std::int32_t block, std::int32_t first_plane, std::int32_t end_plane);
  /// Returns the bits of the balls that a vertex is near to. `facets`: the triangles inside the balls, or null.
  std::uint32_t (*near)(const BallBlock<Real>& balls, const FacetBlock<Real>* facets, const Real* point,
                        const Real* normal);
  /// Compares the group of vertices in lane `at` of one block with those in the lanes of another one: finds upper
  /// bounds of how far they have approached each other, counting only the way within `reach`. Returns the bits of the
  /// lanes in which it is above `enough`, and raises the lanes of `largest` to the others [m].
  std::uint32_t (*approach)(const GroupBoxes<Real>& one, int at, const GroupBoxes<Real>& others, Real reach,
                            Real enough, Real (&largest)[touch_width]);
  std::array<std::int32_t, touch_width> record;
};

/// The kernels without SIMD, in any precision.
template <class Real>
TouchKernels<Real> plain_touch_kernels();

}  // namespace frontalis
