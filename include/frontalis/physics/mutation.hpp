#pragma once

namespace frontalis
{

/// What keeps a motion stable, taken away on purpose to see that tests notice. Only the tests' library
/// frontalis_mutated_solver knows these as variables, set by FRONTALIS_MUTATION in the environment; elsewhere they are
/// constants, and what depends on them is not compiled.
namespace mutation
{

#if defined(FRONTALIS_MUTATIONS)
extern const bool blind_guard;         ///< "guard": finds nothing
extern const bool time_step_of_rest;   ///< "time_step": does not follow what stiffens
extern const bool laws_not_continued;  ///< "material": isochoric laws end where a voxel is crushed
#else
constexpr bool blind_guard = false;
constexpr bool time_step_of_rest = false;
constexpr bool laws_not_continued = false;
#endif

}  // namespace mutation
}  // namespace frontalis
