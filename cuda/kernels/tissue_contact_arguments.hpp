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

/// See TouchingSurface::Triangle. Values of its corners are repeated here, so that they need not be waited for.
struct alignas(16) TouchTriangle
{
  std::int32_t vertex[3];
  float x;  ///< position of corner 0 at rest [m]
  std::int32_t neighbour[3];
  float y;
  float side[2][3];   ///< from corner 0 to the others, at rest [m]
  float per_area[3];  ///< stiffness per area of the corners' vertices [N/m3]
  float z;
};

/// A pair of a vertex and a triangle, with its state of friction (physics::PairGrip).
struct alignas(16) TouchPair
{
  std::int32_t triangle;  ///< -1: no pair
  float held, pressed, along, stretch[3];
  std::int32_t began;  ///< in patches, the vertex of the triangle that was nearest when the present plan began
};

/// Force on a vertex and moment on its normal, in units of TissueContactArguments.
struct alignas(16) TouchSum
{
  unsigned long long force[3], turn[3];
};

/// State of the search. Values that kernels maximise with atomicMax are stored as the bits of floats; the bits have the
/// order of the floats, because the values are not negative.
struct TouchControl
{
  std::uint32_t moved;   ///< largest displacement of a vertex since the latest search [m]
  std::uint32_t speed;   ///< largest speed of a vertex at the start of the plan [m/s]
  std::uint32_t radius;  ///< largest distance of a corner from its triangle's centre when triangles were sorted [m]
  std::uint32_t radius_found;  ///< largest such distance so far while triangles are being sorted [m]
  float reach;                 ///< distance within which the latest search found pairs [m]; 0: there was none yet
  float dt;                    ///< length of the latest step [s]
  std::uint32_t entries;       ///< number of entries in all lists
  std::uint32_t done;          ///< number of blocks that have ended the search
};

/// The vertices of a patch, as ranges of arrays. Each copy of a voxel has copies of its vertices.
struct alignas(16) TouchPatch
{
  std::uint32_t vertex_begin, vertices;
  std::uint32_t voxel_begin, voxels;
};

/// An entry of a patch's list: a vertex whose pairs may push the patch's vertices in the steps of a plan. Every list
/// that has a vertex computes its pairs, each with a copy of their state.
struct TouchEntry
{
  TouchPair pair[2];
};

/// What patches need to find the forces within their steps. A patch places the vertices of its voxels. Of the copies of
/// a vertex, one publishes the vertex for other patches, as displacements of nodes are (patch_exchange.cuh).
struct TouchPatches
{
  const TouchPatch* patches;  ///< per patch; null: patches do not find the forces
  std::uint32_t patch_count;
  const uint4* corners;            ///< of each copy: corners of its voxel, like StepArguments::patch_corners
  const std::uint32_t* vertex_of;  ///< of each copy: the vertex; bit 31: this copy publishes it
  std::uint32_t copy_count;
  float4* before;                ///< of each copy: its displacement at the latest step [m]
  const BoundVoxel* voxels;      ///< the patches' voxels that have vertices
  const std::uint16_t* copy_of;  ///< [patch][vertex]: index of the copy in the patch; no_touch_copy
  /// per vertex, first entry of `near`: of the patches that have the vertex, and further on, of those that have a
  /// vertex of a triangle near the vertex; ascending
  const std::uint32_t* near_begin;
  const std::uint16_t* near;
  /// A triangle is near a vertex if one of its corners is at rest within this distance [m]. In the steps of
  /// a plan, pairs reach triangles that are near TouchPair::began.
  float slide;
  float per_newton;  ///< number of units of force in 1 N; sums have 32 bits
  /// per patch: number of the vertices in its list that it has, and of others. The first are at the beginning of the
  /// list, the others at its end, so that the pairs of a warp push the same of their vertices.
  std::uint32_t* counts;
  std::uint32_t* lists;         ///< [patch][place in the list]: entry, at a stride of the number of vertices
  TouchEntry* entries;          ///< of all lists
  std::uint32_t* entry_vertex;  ///< of each entry: the vertex; bit 31: this entry's state is the one that is kept
  float4* words[2];             ///< three per vertex: displacement, normal, change; each with the number of its step
  const std::uint32_t* watch_begin;  ///< per patch, first entry of `watched`
  const std::uint16_t* watched;      ///< other patches with which the patch is in a list of `near` of a pair's vertex
  float4* ended[2];                  ///< per patch: a word with the number of the step for which it is ready
};
constexpr std::uint16_t no_touch_copy = 0xffff;
constexpr std::uint32_t touch_mark = 0x80000000u, touch_words = 3;
/// Sums per vertex of a patch: components of the force and of the moment on the normal.
constexpr std::uint32_t touch_components = 6;
/// Words of 16 bytes of shared memory for each vertex of a patch: five, `touch_ahead` entries of its list, each of four
/// words and a number of 4 bytes, the sums, and at least one number more.
constexpr std::uint32_t touch_ahead = 3, touch_room = 5 + 4 * touch_ahead + (touch_components + touch_ahead + 4) / 4;

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
  bool measures;              ///< whether the energies are wanted, on a copy of the state
  TouchPatches in_patches;

  // State:
  float4* moved;     ///< displacement of each vertex at the latest step [m]
  float4* searched;  ///< displacement at the latest search [m]
  TouchPair* pairs;
  double* lost;  ///< energy lost to friction at each vertex [J]
  TouchControl* control;

  // Values of the present step or search:
  float4 *placed, *normal;  ///< displacement [m], in steps the same array as `moved`; normal
  float4* change;           ///< change of the displacement in the latest step [m]; null without friction
  float4* dual;             ///< two per vertex: physics::SurfaceVertex::dual
  /// Force and moment per vertex, in units of force and in units of force times `edge`. The sums of whole numbers do
  /// not depend on the order, so that threads may add in any order, and reactions are exact opposites.
  TouchSum* sums;
  float* stored;               ///< energy stored at each vertex [J]
  std::int32_t *heads, *next;  ///< first triangle of each bucket, and the one that follows each triangle; -1: none
};

}  // namespace frontalis
