#pragma once

#include "device_model.hpp"

namespace frontalis
{
namespace cuda
{

/// How a model's voxels are cut up. Small models are cut into bricks of the size that promises the shortest step; large
/// ones into strips. FRONTALIS_CUDA_BRICKS in the environment asks for bricks of so many
/// rows and planes (33: three of each; 0: strips), for measuring.
CutChoice choose_cut(const Model& model, Effects effects);

/// Throws Error where this build has no code for the device.
StepLaunch choose_launch(DeviceModel& device);

}  // namespace cuda
}  // namespace frontalis
