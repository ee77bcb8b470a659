#pragma once

#include "cuda/kernels/tissue_contact_arguments.hpp"

namespace frontalis
{

struct StepArguments;

/// Before `steps` steps of length `dt` [s]: searches for pairs if the motion requires it, and makes the lists of
/// patches. The displacements `u` and velocities `v` are those of device nodes.
cudaError_t launch_touch_search(const TissueContactArguments& contact, const float4* u, const float* const (&v)[3],
                                double dt, int steps, cudaStream_t stream);

/// Finds the forces of contact of tissue with itself at displacements `u` of nodes and stores them in contact.sums.
/// `dt`: length of the step [s].
cudaError_t launch_touch(const TissueContactArguments& contact, const float4* u, double dt, cudaStream_t stream);

/// Stores in contact.sums the forces of vertices that all touch and stick, as in ContactStiffness.
cudaError_t launch_touch_springs(const TissueContactArguments& contact, const float4* u, cudaStream_t stream);

/// Passes the forces of contact.sums on to nodes, as launch_push_nodes() does.
cudaError_t launch_push_touching(const StepArguments& arguments, const TissueContactArguments& contact, float factor,
                                 float* const (&v)[3], cudaStream_t stream);

}  // namespace frontalis
