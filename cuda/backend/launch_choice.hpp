#pragma once

#include "cuda/backend/device_model.hpp"

namespace frontalis
{
namespace cuda
{

/// How a model's voxels are cut up: into as few patches per multiprocessor as its shared memory allows, large models
/// into strips. For tests and for measuring, the environment can ask for another cut or play a smaller GPU:
/// FRONTALIS_CUDA_PATCHES: patches per multiprocessor (0: strips); FRONTALIS_CUDA_PLANES: planes per strip;
/// FRONTALIS_CUDA_SEARCHES: StepArguments::searches; FRONTALIS_CUDA_SHARED_BYTES and FRONTALIS_CUDA_MULTIPROCESSORS: at
/// most so much shared memory per block and so many multiprocessors are used.
CutChoice choose_cut(const Model& model, Effects effects);

/// Throws BackendUnavailable where the device cannot hold the launch.
StepLaunch choose_launch(const DeviceModel& device);

}  // namespace cuda
}  // namespace frontalis
