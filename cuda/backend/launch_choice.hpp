#pragma once

#include "cuda/backend/device_model.hpp"

namespace frontalis
{
namespace cuda
{

/// Cuts a model into as few patches per multiprocessor as the shared memory allows, or into strips if the model is too
/// large for patches. Environment variables override the choice in tests and measurements. FRONTALIS_CUDA_PATCHES sets
/// the number of patches per multiprocessor (0: strips) and FRONTALIS_CUDA_PLANES that of planes per strip.
/// FRONTALIS_CUDA_SHARED_BYTES limits the shared memory per block and FRONTALIS_CUDA_MULTIPROCESSORS the number of
/// multiprocessors, as on a smaller GPU. `effects`: those of the model in strips.
CutChoice choose_cut(const Model& model, Effects effects);

/// Throws BackendUnavailable if the device cannot run the launch.
StepLaunch choose_launch(const DeviceModel& device);

}  // namespace cuda
}  // namespace frontalis
