#pragma once

#include "cuda/kernels/step_kernel.hpp"

#include <cuda_runtime_api.h>
#include <vector_types.h>

#include <cstdint>

namespace frontalis
{

/// A triangulated surface whose vertices are bound to voxels. Pointers are to device memory.
struct BoundSurface
{
  std::uint32_t vertex_count, triangle_count;
  const std::uint32_t* nodes;  ///< eight device nodes per vertex
  const float* coordinates;    ///< three per vertex, within its voxel
  const double* rest;          ///< three per vertex [m]
  const int3* triangles;
  const std::int32_t* around_begin;  ///< the triangles around vertex v, ascending, begin at around[around_begin[v]]
  const std::int32_t* around;
};

/// Computes positions of the vertices at displacements `u`, three per vertex [m].
cudaError_t launch_place(const BoundSurface& surface, const float4* u, float* positions, cudaStream_t stream);
/// Computes unit normals from positions: the area-weighted mean over the adjacent triangles, three per vertex.
cudaError_t launch_normals(const BoundSurface& surface, const float* positions, float* normals, cudaStream_t stream);
/// Computes the force of a follower pressure on each vertex of each triangle at displacements `u`, in double precision,
/// three per triangle [N]: a third of the force on the triangle. `pressure`: of each triangle [Pa].
cudaError_t launch_pressure(const BoundSurface& surface, const double* pressure, const float4* u, double* forces,
                            cudaStream_t stream);
/// Computes the forces of surface loads on `count` loaded nodes in a step of the plan, three per node [N].
cudaError_t launch_node_loads(const StepArguments& arguments, std::uint32_t count, int step, double* forces,
                              cudaStream_t stream);
/// Sets the displacement of nodes that never move to 0.
cudaError_t launch_hold(const std::uint32_t* nodes, std::uint32_t count, float4* u, cudaStream_t stream);

}  // namespace frontalis
