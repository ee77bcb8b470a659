#pragma once

#include "frontalis/physics/element/node_motion.hpp"
#include "solver/cpu/slide_kernel.hpp"
#include "solver/cpu/voxel_rows.hpp"

namespace frontalis
{

/// Stretch and stress of the fibres of a tile when their work was computed last, for the energy ledger.
struct FibreMemory
{
  float squared[Tile::width];  ///< stretch squared
  float stress[Tile::width];   ///< fibre stress times weight [N m]
};

/// One time step over planes of nodes, or a part of it. Plain pointers only: the kernels are compiled once per
/// instruction set, and nothing that they instantiate may be shared with other translation units. Real is the number
/// type of the state; parameters are floats.
template <class Real>
struct CpuKernelArguments : physics::Kick<Real>
{
  const Real* u[3];           ///< displacements [m]; readable Tile::width numbers past the end
  Real* next[3];              ///< displacements after the step [m]
  Real* v[3];                 ///< velocities [m/s]
  Real* rounding[3];          ///< rounding errors of the displacements [m]; null: not kept
  const float* inverse_mass;  ///< [1/kg]
  const float* mobility;      ///< the same, 0 where a node is held [1/kg]
  const Tile* tiles;
  const std::int32_t* plane_tiles;
  const std::int32_t* plane_nodes;
  std::int32_t planes;
  const TileStiffness* stiffness;
  const TileStabilisation* stabilisation;  ///< null: scalar hourglass control alone
  bool selective_reduced;                  ///< eight Gauss points instead of hourglass control
  const FibreSlot* fibres;                 ///< null: fibres have no stress
  const LawSlot* laws;
  const ViscousSlot* viscous;
  float* relaxed;  ///< relaxed stress times volume [N m], relaxed_tensors() * 6 * Tile::width per ViscousSlot
  std::int32_t viscous_terms;  ///< 0: none, or viscosity is switched off
  Real viscous_elapsed;        ///< [s] since the relaxed stresses were renewed last
  double* viscous_work;        ///< two per plane: sums of the change of H : E, and of H : E; null: not wanted
  const float* activation;     ///< one per muscle
  const float* with_length;    ///< one per muscle: 1 or 0
  const float* with_passive;   ///< one per muscle: 1 or 0
  FibreMemory* fibre_memory;   ///< one per FibreSlot; null: no ledger
  double* muscle_work;         ///< one per plane [J]; null: only fibre_memory is renewed
  Real scale[3];               ///< 1 / (4 h)
  Real stretch_weight[3];      ///< 1/h^2 over the sum of the three
  Real stretch_half_sum;       ///< half of that sum [1/m2]
  Real hourglass_weight[3];    ///< 1 / (4 sqrt(3) h)
  Real dt;
  Real kick;                   ///< for how long forces change velocities: dt, except in the first step of a plan [s]
  std::int32_t buffer_stride;  ///< numbers per component of a plane buffer
};

enum class KernelTask
{
  step,           ///< updates v and next
  step_and_look,  ///< the same, and the bound of the highest frequency squared now
  forces,         ///< internal forces into next, nothing updated
  relax           ///< viscous stresses relax, nothing else
};

/// Steps the nodes of planes [first, last); buffer has 8 * buffer_stride numbers. Returns the bound of the highest
/// frequency squared [1/s2] that these nodes allow (step_and_look), NaN where motion is not finite.
template <class Real>
using CpuKernel = Real (*)(const CpuKernelArguments<Real>& arguments, std::int32_t first, std::int32_t last,
                           Real* buffer, KernelTask task);

struct PlaneMonitor;

/// Energies and worst voxels of the voxel planes [first, last) at g.u, one per plane, and the stiffness bound of each
/// voxel [N/m].
using CpuMonitorKernel = void (*)(const CpuKernelArguments<double>& g, std::int32_t first, std::int32_t last,
                                  PlaneMonitor* planes, double* stiffness);

struct CpuKernelChoice
{
  CpuKernel<float> single;
  CpuKernel<double> wide;
  SlideKernel<float> slide;
  CpuMonitorKernel monitor;
  const char* name;
};

/// The kernels for the widest instruction set that this machine has; FRONTALIS_INSTRUCTION_SET (baseline, avx2, avx512)
/// in the environment asks for another. Throws Error if it is not there.
CpuKernelChoice choose_cpu_kernel();

}  // namespace frontalis
