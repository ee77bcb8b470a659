#pragma once

#include "cuda_solver.hpp"

namespace frontalis
{
namespace cuda
{

/// Mode of the highest frequency, and room for its product with the stiffness. The mode is left as long as it comes:
/// products are taken of it divided by `largest`.
struct CudaSolver::Mode
{
  DeviceArray<float4> mode, moved, plus, minus;
  DeviceArray<double2> seen;
  double largest, length;

  explicit Mode(std::size_t nodes)
      : mode(nodes), moved(nodes), plus(nodes), minus(nodes), seen(product_blocks), largest(0), length(0)
  {
    for (const auto* forces : { &plus, &minus })
      require(cudaMemset(forces->data(), 0, forces->bytes()), "clearing forces");
  }
};

}  // namespace cuda
}  // namespace frontalis
