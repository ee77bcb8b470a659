#pragma once

#include <cuda_runtime_api.h>

namespace frontalis
{
namespace cuda
{

/// Fails where this build has no machine code for the device and its driver cannot compile the PTX.
cudaError_t has_device_code();

}  // namespace cuda
}  // namespace frontalis
