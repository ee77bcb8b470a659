#include "cuda/backend/device_code.hpp"

namespace frontalis
{
namespace cuda
{
namespace
{

// an empty kernel, compiled for the same architectures as all others
__global__ void probe() {}

}  // namespace

cudaError_t has_device_code()
{
  cudaFuncAttributes attributes{};
  return cudaFuncGetAttributes(&attributes, probe);
}

}  // namespace cuda
}  // namespace frontalis
