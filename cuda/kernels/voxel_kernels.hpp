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
  double* account;  ///< two per voxel: sum of the changes of H : E by relaxation, H : E now [J]; null: none kept
};

/// A voxel with fibres, whose work is accounted for.
struct FibreVoxel
{
  std::uint32_t node[8];  ///< device nodes
  std::uint32_t first, count;
};

struct FibreVoxels
{
  const FibreVoxel* voxels;
  std::uint32_t count;
  float2* memory;  ///< stress and squared stretch at the latest look, one per fibre entry
  double* work;    ///< done by the fibres of each voxel [J]
};

/// Work of a step on nodes.
struct NodeAccount
{
  std::uint32_t nodes;
  double* damping;     ///< lost to damping [J]
  double* constraint;  ///< done by constraints [J]
  double* beside;      ///< three per node: how far constraints moved it beside dt v in the latest step [m]
  std::uint32_t loaded_nodes;
  const std::uint32_t* loaded;  ///< device nodes
  double* load;                 ///< done by surface loads, one per loaded node [J]
};

/// Viscous stresses relax by `elapsed` [s] towards those at displacements u (physics/viscosity.hpp); u_before: a step
/// earlier, for the account of energies alone.
cudaError_t launch_relaxation(const StepArguments& arguments, const ViscousVoxels& viscous, const float4* u,
                              const float4* u_before, float elapsed, cudaStream_t stream);
/// Adds the work that fibres did since the latest call, with the activations of a step. open: the account begins.
cudaError_t launch_fibre_work(const StepArguments& arguments, const FibreVoxels& fibres, const float4* u, int step,
                              bool open, cudaStream_t stream);
/// Adds the work on the nodes in the step that was done last (physics/element/node_motion.hpp).
cudaError_t launch_node_account(const StepArguments& arguments, const NodeAccount& account, double damping, int step,
                                cudaStream_t stream);

/// out = u + amount times mode over the root of the mass; held nodes stay (StepArguments::mobility).
cudaError_t launch_displace(std::uint32_t nodes, const float* mobility, const float4* u, const float4* mode,
                            float amount, float4* out, cudaStream_t stream);

/// Blocks whose sums launch_product() leaves, two numbers each: largest size of a component over the root of the mass;
/// sum of squares.
constexpr int product_blocks = 128;

/// mode = (forces - present) times factor over the root of the mass, 0 at held nodes; seen: sums as above.
cudaError_t launch_product(std::uint32_t nodes, const float* mobility, const float4* u, const float4* forces,
                           const float4* present, float factor, float4* mode, double2* seen, cudaStream_t stream);

}  // namespace frontalis
