#pragma once

#include "frontalis/physics/element/node_motion.hpp"
#include "solver/cpu/part_kernels.hpp"
#include "solver/cpu/voxel_rows.hpp"

namespace frontalis
{

/// Stretch and stress of a tile's fibres when their work was last computed, for the energy ledger.
struct FibreMemory
{
  float squared[Tile::width];  ///< stretch squared
  float stress[Tile::width];   ///< fibre stress times weight [N m]
};

/// Arguments of one time step, or of a part of it, over planes of nodes. They are plain pointers, because the kernels
/// are compiled once per instruction set and must not instantiate anything that other translation units share. Real is
/// the number type of the state; parameters are floats.
template <class Real>
struct CpuKernelArguments : physics::Kick<Real>
{
  const Real* u[3];           ///< displacements [m]; Tile::width numbers beyond the end must be readable
  Real* next[3];              ///< displacements after the step [m]
  Real* v[3];                 ///< velocities [m/s]
  Real* rounding[3];          ///< rounding errors of the displacements [m]; null without compensated precision
  const float* inverse_mass;  ///< [1/kg]
  const float* mobility;      ///< for the bound of the frequency: inverse mass, or less, 0 for held nodes [1/kg]
  const Tile* tiles;
  const std::int32_t* plane_tiles;
  const std::int32_t* plane_nodes;
  std::int32_t planes;
  const TileStiffness* stiffness;
  const TileStabilisation* stabilisation;  ///< null: scalar hourglass control
  bool selective_reduced;                  ///< eight Gauss points instead of hourglass control
  const FibreSlot* fibres;                 ///< null: the effect is switched off
  const std::int32_t* fibre_muscle;        ///< muscle of each FibreSlot
  const LawSlot* laws;
  const ViscousSlot* viscous;
  const CutSlot* cut;
  float* relaxed;  ///< relaxed stress times volume [N m], relaxed_tensors() * 6 * Tile::width per ViscousSlot
  std::int32_t viscous_terms;  ///< 0: no viscosity, or it is switched off
  Real viscous_elapsed;        ///< time since the latest relaxation [s]
  /// two per plane: change of H : E, and present H : E (physics/viscosity.hpp); null: not needed
  double* viscous_work;
  const float* activation;    ///< one per muscle
  const float* with_length;   ///< one per muscle: 1 if the tension-length relation applies, else 0
  const float* with_passive;  ///< one per muscle: 1 if it has passive stress, else 0
  FibreMemory* fibre_memory;  ///< one per FibreSlot; null: there is no ledger
  double* muscle_work;        ///< one per plane [J]; null: only fibre_memory is updated
  Real scale[3];              ///< 1 / (4 h)
  Real stretch_weight[3];     ///< 1/h^2 divided by the sum over the three axes
  Real stretch_half_sum;      ///< half of that sum over the axes [1/m2]
  Real hourglass_weight[3];   ///< 1 / (4 sqrt(3) h)
  Real dt;
  Real kick;                   ///< time over which forces change velocities: dt, except in a plan's first step [s]
  std::int32_t buffer_stride;  ///< numbers per component of a plane buffer
};

enum class KernelTask
{
  step,            ///< updates v and next
  step_and_bound,  ///< updates v and next, and computes the squared frequency bound
  forces,          ///< writes internal forces to `next`, updates nothing
  relax            ///< relaxes viscous stresses only
};

/// Steps the nodes of planes [first, last). `buffer` has 8 * buffer_stride numbers. Returns the bound of the squared
/// highest frequency [1/s2] at these nodes (step_and_bound), or NaN if the motion is not finite.
template <class Real>
using CpuKernel = Real (*)(const CpuKernelArguments<Real>& arguments, std::int32_t first, std::int32_t last,
                           Real* buffer, KernelTask task);

struct PlaneMonitor;

/// Computes the energies, and the voxel with the smallest J, of voxel planes [first, last) at g.u, one entry per plane,
/// and the stiffness bound of each voxel [N/m].
using CpuMonitorKernel = void (*)(const CpuKernelArguments<double>& g, std::int32_t first, std::int32_t last,
                                  PlaneMonitor* planes, double* stiffness);

struct CpuKernelChoice
{
  CpuKernel<float> single;
  CpuKernel<double> wide;
  PartKernels<float> parts;
  CpuMonitorKernel monitor;
  const char* name;
};

/// Returns the kernels for the widest instruction set of this machine. The environment variable
/// FRONTALIS_INSTRUCTION_SET (baseline, avx2, avx512) selects another. Throws Error if the machine does not have it.
CpuKernelChoice choose_cpu_kernel();

}  // namespace frontalis
