#pragma once

#include <cuda_runtime_api.h>
#include <vector_types.h>

#include <cstdint>

namespace frontalis
{

/// A triangulated surface whose vertices are tied to voxels. Pointers are to device memory.
struct BoundSurface
{
  std::uint32_t vertex_count;
  const std::uint32_t* nodes;  ///< eight device nodes per vertex
  const float* coordinates;    ///< three per vertex, in its voxel
  const double* rest;          ///< three per vertex [m]
  const int3* triangles;
  const std::int32_t* around_begin;  ///< triangles around each vertex, ascending: around[around_begin[v]] ..
  const std::int32_t* around;
};

/// Positions of the vertices at displacements u, three per vertex [m].
cudaError_t launch_place(const BoundSurface& surface, const float4* u, float* positions, cudaStream_t stream);
/// Unit normals from positions: area-weighted mean of the triangles', three per vertex.
cudaError_t launch_normals(const BoundSurface& surface, const float* positions, float* normals, cudaStream_t stream);
/// Force on each vertex of a follower pressure [Pa] at displacements u: a third of its triangles', in
/// double [N].
cudaError_t launch_pressure(const BoundSurface& surface, const float4* u, double pressure, double* positions,
                            double* forces, cudaStream_t stream);
/// Sets the displacement of nodes that never move to 0.
cudaError_t launch_hold(const std::uint32_t* nodes, std::uint32_t count, float4* u, cudaStream_t stream);

}  // namespace frontalis
