#pragma once

#include <cuda_runtime_api.h>

namespace frontalis
{
namespace cuda
{

/// Returns an error if this build has no machine code for the device and the driver cannot compile its PTX.
cudaError_t has_device_code();

}  // namespace cuda
}  // namespace frontalis
