#pragma once

#include "cuda/kernels/shell_arguments.hpp"

namespace frontalis
{

/// Terms of the force on each vertex: [sums[v].x, sums[v].x + sums[v].y) of `terms`, which say where the x component of
/// a triangle's force is.
struct ShellSums
{
  const uint2* sums;
  const std::uint32_t* terms;
};

/// Finds the forces on all vertices of shells at displacements `u` of nodes and leaves them in points.pushes. For
/// strips. `moved`: room for displacements of vertices. `forces`: room for those of triangles.
cudaError_t launch_shell_forces(const ShellTriangles& triangles, const ShellSums& sums, const BoundPoints& points,
                                const float4* u, float4* moved, float* forces, cudaStream_t stream);

}  // namespace frontalis
