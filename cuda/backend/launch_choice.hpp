#pragma once

#include "cuda/backend/device_model.hpp"

namespace frontalis
{
namespace cuda
{

/// How a model's voxels are cut up: into as few patches a multiprocessor as its shared memory allows; large models into
/// strips. FRONTALIS_CUDA_PATCHES in the environment asks for so many patches a multiprocessor (0: strips),
/// FRONTALIS_CUDA_SEARCHES for so many searches ahead in strips (StepArguments::searches), for tests and for measuring.
CutChoice choose_cut(const Model& model, Effects effects);

/// Throws Error where this build has no code for the device.
StepLaunch choose_launch(const DeviceModel& device);

}  // namespace cuda
}  // namespace frontalis
