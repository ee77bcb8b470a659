#pragma once

#include "cuda/backend/cuda_solver.hpp"

namespace frontalis
{
namespace cuda
{

/// The mode of the highest frequency, and memory for its product with the stiffness. The mode is not normalised:
/// products use the mode divided by `largest`.
struct CudaSolver::Mode
{
  DeviceArray<float4> mode, moved, forces, present;
  DeviceArray<double2> seen;
  double largest, length;

  explicit Mode(std::size_t nodes)
      : mode(nodes), moved(nodes), forces(nodes), present(nodes), seen(product_blocks), largest(0), length(0)
  {
    for (const auto* field : { &forces, &present })
      require(cudaMemset(field->data(), 0, field->bytes()), "clearing forces");
  }

  std::size_t bytes() const { return mode.bytes() + moved.bytes() + forces.bytes() + present.bytes() + seen.bytes(); }
};

}  // namespace cuda
}  // namespace frontalis
