#pragma once

#include "cuda/kernels/bound_points.hpp"

namespace frontalis
{

/// A vertex of a surface that may touch other parts of the tissue (TouchingSurface::Vertex).
struct alignas(16) TouchVertex
{
  float4 rest;        ///< position at rest [m]; stiffness per area of the vertex [N/m3]
  float4 tangent[2];  ///< tangents at rest
  float stiffness;    ///< [N/m]
  float overlap;      ///< gap at rest, not positive; the depth of contact is measured from it [m]
  float friction;
  std::int32_t contact, source;
};

/// See TouchingSurface::Triangle.
struct alignas(16) TouchTriangle
{
  std::int32_t vertex[3], neighbour[3], unused[2];
};

/// A pair of a vertex and a triangle, with its state of friction (physics::PairGrip).
struct alignas(16) TouchPair
{
  std::int32_t triangle;  ///< -1: no pair
  float held, pressed, along, stretch[3], unused;
};

/// What the kernels of a step do besides finding forces.
enum class TouchStage : std::uint32_t
{
  hold,   ///< nothing
  sort,   ///< sort triangles into cells
  search  ///< search near each vertex, in the step after `sort`
};

/// Force on a vertex and moment on its normal, in units of TissueContactArguments.
struct alignas(16) TouchSum
{
  unsigned long long force[3], turn[3];
};

/// State of the search. Lengths that kernels maximise with atomicMax are stored as the bits of floats; the bits have
/// the order of the floats, because lengths are not negative.
struct TouchControl
{
  TouchStage stage, next;  ///< of the present and of the next step
  std::uint32_t moved;     ///< largest displacement of a vertex since the latest search [m]
  std::uint32_t radius;    ///< largest distance of a corner from its triangle's centre when triangles were sorted [m]
  std::uint32_t radius_found;  ///< largest such distance so far while triangles are being sorted [m]
  float cell;                  ///< edge of the grid's cells [m]
  float dt;                    ///< length of the latest step [s]
};

/// Contact of tissue with itself in device memory. Vertices are sorted by voxel. The pairs of vertex v are entries 2 v
/// and 2 v + 1.
struct TissueContactArguments
{
  BoundPoints bound;  ///< the vertices; its pushes are not used
  const TouchVertex* vertices;
  const TouchTriangle* triangles;
  const std::int32_t *joined_begin, *joined_sources;  ///< of TouchingSurface
  std::uint32_t vertex_count, triangle_count;
  std::uint32_t bucket_mask;  ///< number of buckets of the grid, a power of 2, minus 1
  float edge;                 ///< shortest voxel edge [m]
  float inverse_spacing[3];   ///< [1/m]
  float per_newton;           ///< number of units of force in 1 N
  bool rubs;                  ///< whether there is friction
  /// Whether only the forces at the given displacements are wanted, so that no search is begun or continued.
  bool looks_only;

  // State:
  float4 *moved, *normal;  ///< displacement [m] and normal of each vertex
  float4* change;          ///< change of the displacement in the latest step [m]; null without friction
  float4* searched;        ///< displacement at the latest search [m]
  TouchPair* pairs;
  double* lost;  ///< energy lost to friction at each vertex [J]
  TouchControl* control;
  std::int32_t *heads, *next;  ///< first triangle of each bucket, and the one that follows each triangle; -1: none

  // Values of the present step:
  float4* dual;  ///< two per vertex: physics::SurfaceVertex::dual
  /// Force and moment per vertex, in units of force and in units of force times `edge`. The sums of whole numbers do
  /// not depend on the order, so that threads may add in any order, and reactions are exact opposites.
  TouchSum* sums;
  float* stored;  ///< energy stored at each vertex [J]
};

}  // namespace frontalis
