#pragma once

#include <cstddef>

namespace frontalis
{

/// Data of bare_loop() (frontalis/study/step_time.hpp). Nodal arrays are one per component, nodes along x fastest.
struct BareLoop
{
  int nodes_per_edge;
  const float* u[3];                      ///< displacements [m]
  float* next[3];                         ///< displacements after the step [m]
  float* v[3];                            ///< velocities [m/s]
  const float* mu;                        ///< one per voxel [Pa]
  const float* kappa;                     ///< one per voxel [Pa]
  float spacing, dt, keep, inverse_mass;  ///< [m], [s], factor on the velocity per step (damping), per node [1/kg]
};

/// Performs one step of the node planes [first, last); scratch holds 6 * plane floats, plane = nodes_per_edge^2 + 64.
using BareLoopKernel = void (*)(const BareLoop& loop, int first, int last, float* scratch);

void bare_loop_baseline(const BareLoop&, int, int, float*);
#if defined(__x86_64__)
void bare_loop_avx2(const BareLoop&, int, int, float*);
void bare_loop_avx512(const BareLoop&, int, int, float*);
#endif

}  // namespace frontalis
