#pragma once

#include "cuda/kernels/shell_arguments.hpp"

namespace frontalis
{

/// Finds the forces on all vertices of shells at displacements `u` of nodes and leaves them in points.pushes. For
/// strips. `moved`, `forces`: see ShellArguments; room for all of them.
cudaError_t launch_shell_forces(const ShellArguments& shell, const PatchShell& all, const BoundPoints& points,
                                const float4* u, float4* moved, float* forces, cudaStream_t stream);

}  // namespace frontalis
