#pragma once

#include <cstddef>

namespace frontalis
{

/// Arrays of the bare loop: components one after the other, nodes along x fastest.
struct BareLoop
{
  int nodes_an_edge;
  const float* u[3];
  float* next[3];
  float* v[3];
  const float* mu;     ///< one per voxel [Pa]
  const float* kappa;  ///< one per voxel [Pa]
  float spacing, dt, keep, inverse_mass;
};

/// One step of the node planes [first, last); scratch holds 6 * plane floats, plane = nodes_an_edge^2 + 64.
using BareLoopKernel = void (*)(const BareLoop& loop, int first, int last, float* scratch);

void bare_loop_baseline(const BareLoop&, int, int, float*);
#if defined(__x86_64__)
void bare_loop_avx2(const BareLoop&, int, int, float*);
void bare_loop_avx512(const BareLoop&, int, int, float*);
#endif

}  // namespace frontalis
