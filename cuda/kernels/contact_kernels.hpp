#pragma once

#include "cuda/kernels/pushed_bodies.hpp"
#include "cuda/kernels/step_kernel.hpp"

namespace frontalis
{

/// Number of points, or of voxels with added stress, that a block processes.
constexpr int contact_block = 128;

/// Number of blocks that find the forces on so many points.
std::uint32_t find_pushes_blocks(std::uint32_t points);

/// Finds the forces on all points of contact at displacements g.u[g.first], at the start of a step. Used for strips.
/// Bodies that are pushed are moved on to this step first.
cudaError_t launch_find_pushes(const StepArguments& arguments, const PushedBodies& pushed, int step,
                               cudaStream_t stream);

}  // namespace frontalis
