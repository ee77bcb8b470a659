#pragma once

#include "cuda/kernels/shell_arguments.hpp"

namespace frontalis
{

/// Terms of the force on each vertex v: entries sums[v].x to sums[v].x + sums[v].y - 1 of `terms`. A term is the
/// position of the x component of a triangle's force on the vertex.
struct ShellSums
{
  const uint2* sums;
  const std::uint32_t* terms;
};

/// Finds the forces on all vertices of shells at displacements `u` of nodes and stores them in points.pushes. Used for
/// strips. `moved`: memory for displacements of vertices. `forces`: memory for the forces of triangles.
cudaError_t launch_shell_forces(const ShellTriangles& triangles, const ShellSums& sums, const BoundPoints& points,
                                const float4* u, float4* moved, float* forces, cudaStream_t stream);

}  // namespace frontalis
