#include "cuda/backend/device_code.hpp"

namespace frontalis
{
namespace cuda
{
namespace
{

// An empty kernel that is compiled for the same architectures as all others.
__global__ void probe() {}

}  // namespace

cudaError_t has_device_code()
{
  cudaFuncAttributes attributes{};
  return cudaFuncGetAttributes(&attributes, probe);
}

}  // namespace cuda
}  // namespace frontalis
