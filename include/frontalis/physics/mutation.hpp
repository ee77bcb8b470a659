#pragma once

namespace frontalis
{

/// Parts of the solver that are removed on purpose, to check that tests notice. In the test library
/// frontalis_mutated_solver they are variables, which the environment variable FRONTALIS_MUTATION sets. Elsewhere they
/// are constants, and code that depends on them is not compiled.
namespace mutation
{

#if defined(FRONTALIS_MUTATIONS)
extern const bool blind_guard;         ///< "guard": the guard detects nothing
extern const bool time_step_of_rest;   ///< "time_step": the bound of the time step ignores stiffening
extern const bool laws_not_continued;  ///< "material": isochoric laws are not continued for crushed voxels
extern const bool no_friction;         ///< "friction": no friction force
extern const bool lost_corner;         ///< "patches": nodes of patches lack the force of one voxel
extern const bool no_gpu_gravity;      ///< "gpu_gravity": gravity does not act on the GPU
#else
constexpr bool blind_guard = false;
constexpr bool time_step_of_rest = false;
constexpr bool laws_not_continued = false;
constexpr bool no_friction = false;
constexpr bool lost_corner = false;
constexpr bool no_gpu_gravity = false;
#endif

}  // namespace mutation
}  // namespace frontalis
