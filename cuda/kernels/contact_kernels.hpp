#pragma once

#include "cuda/kernels/step_kernel.hpp"

namespace frontalis
{

/// Finds the forces on all points of contact at displacements g.u[g.first], at the start of a step. For strips.
cudaError_t launch_find_pushes(const StepArguments& arguments, int step, cudaStream_t stream);

/// Adds `factor` [s] times their accelerations to the velocities `v` of nodes. `v` null: adds the opposite of the
/// forces to g.u[1 - g.first], which holds internal forces.
cudaError_t launch_push_nodes(const StepArguments& arguments, float factor, float* const (&v)[3], cudaStream_t stream);

}  // namespace frontalis
