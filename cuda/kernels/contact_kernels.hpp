#pragma once

#include "cuda/kernels/step_kernel.hpp"

namespace frontalis
{

/// Finds the forces on all points of contact at displacements g.u[g.first], at the start of a step. Used for strips.
cudaError_t launch_find_pushes(const StepArguments& arguments, int step, cudaStream_t stream);

}  // namespace frontalis
