#pragma once

#include "cuda/kernels/step_kernel.hpp"

namespace frontalis
{

/// A voxel with viscous stresses.
struct ViscousVoxel
{
  std::uint32_t node[8];  ///< device nodes
  std::uint32_t palette;
};

struct ViscousVoxels
{
  const ViscousVoxel* voxels;
  std::uint32_t count;
  double* account;  ///< two per voxel: sum of changes of H : E by relaxation, present H : E [J]; or null
};

/// A voxel with fibres whose work is accounted for.
struct FibreVoxel
{
  std::uint32_t node[8];  ///< device nodes
  std::uint32_t first, count;
  std::uint32_t palette;
};

struct FibreVoxels
{
  const FibreVoxel* voxels;
  std::uint32_t count;
  float2* memory;  ///< stress and squared stretch at the latest call, one per fibre entry
  double* work;    ///< work of the fibres of each voxel [J]
};

/// Memory for the work that is done on nodes in a step.
struct NodeAccount
{
  std::uint32_t nodes;
  double* damping;     ///< energy dissipated by damping [J]
  double* constraint;  ///< work of constraints [J]
  double* beside;      ///< three per node: displacement by constraints in addition to dt v in the latest step [m]
  std::uint32_t loaded_nodes;
  const std::uint32_t* loaded;  ///< device nodes
  double* load;                 ///< work of surface loads, one per loaded node [J]
};

/// Relaxes viscous stresses by `elapsed` [s] towards those at displacements `u` (physics/viscosity.hpp). `u_before`:
/// displacements one step earlier, needed only for the account of energies.
cudaError_t launch_relaxation(const StepArguments& arguments, const ViscousVoxels& viscous, const float4* u,
                              const float4* u_before, float elapsed, cudaStream_t stream);
/// Adds the work of fibres since the previous call, with the activations of a step. `open`: starts the account.
cudaError_t launch_fibre_work(const StepArguments& arguments, const FibreVoxels& fibres, const float4* u, int step,
                              bool open, cudaStream_t stream);
/// Adds the work on nodes in the latest step (physics/element/node_motion.hpp).
cudaError_t launch_node_account(const StepArguments& arguments, const NodeAccount& account, double damping, int step,
                                cudaStream_t stream);

}  // namespace frontalis
