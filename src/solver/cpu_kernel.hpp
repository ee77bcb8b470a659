#pragma once

#include "slide_kernel.hpp"
#include "voxel_rows.hpp"

namespace frontalis
{

/// One time step over planes of nodes, or the internal forces alone. Plain pointers only: the kernels are compiled once
/// an instruction set, and nothing that they instantiate may be shared with other translation units.
struct CpuKernelArguments
{
  const float* u[3];          ///< displacements [m]; readable Tile::width floats past the end
  float* next[3];             ///< displacements after the step [m]
  float* v[3];                ///< velocities [m/s]
  const float* inverse_mass;  ///< [1/kg]
  const Tile* tiles;
  const std::int32_t* plane_tiles;
  const std::int32_t* plane_nodes;
  std::int32_t planes;
  // blocks of Tile::width a tile
  const float* mu;                 ///< shear modulus times tissue volume [N m]
  const float* kappa;              ///< bulk modulus times tissue volume [N m]
  const float* hourglass;          ///< scalar stiffness [N/m]
  const float* assumed_strain[4];  ///< bending, coupling, torsion, warping [N m]; null: scalar hourglass control alone
  const float* frequency_squared;  ///< bound at rest [1/s2]
  const FibreSlot* fibres;
  const LawSlot* laws;
  const float* activation;     ///< one a muscle
  const float* with_length;    ///< one a muscle: 1 or 0
  const float* with_passive;   ///< one a muscle: 1 or 0
  float scale[3];              ///< 1 / (4 h)
  float stretch_weight[3];     ///< 1/h^2 over the sum of the three
  float hourglass_weight[3];   ///< 1 / (4 sqrt(3) h)
  float dt, keep, gain;        ///< v = keep v - gain f / m + impulse
  float impulse[3];            ///< gain times gravity
  std::int32_t buffer_stride;  ///< floats a component of a plane buffer
};

/// What a kernel is asked for besides forces.
enum class KernelTask
{
  step,           ///< updates v and next
  step_and_look,  ///< the same, and the largest frequency bound squared now
  forces          ///< internal forces into next, nothing updated
};

/// Steps the nodes of planes [first, last); buffer has 6 * buffer_stride floats. Returns the largest frequency bound
/// squared [1/s2] over the voxels passed (step_and_look), NaN where motion is not finite.
using CpuKernel = float (*)(const CpuKernelArguments& arguments, std::int32_t first, std::int32_t last, float* buffer,
                            KernelTask task);

struct CpuKernelChoice
{
  CpuKernel kernel;
  SlideKernel<float> slide;
  const char* name;
};

/// The kernels for the widest instruction set that this machine has; FRONTALIS_INSTRUCTION_SET (baseline, avx2, avx512)
/// in the environment asks for another. Throws Error if it is not there.
CpuKernelChoice choose_cpu_kernel();

}  // namespace frontalis
