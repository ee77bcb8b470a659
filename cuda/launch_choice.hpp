#pragma once

#include "device_model.hpp"

namespace frontalis
{
namespace cuda
{

/// How a model's voxels are cut up. Small models want many short strips, because a step is as long as its longest
/// strip; large ones fewer long strips, because what a strip's borders share is computed twice. FRONTALIS_CUDA_ROWS and
/// FRONTALIS_CUDA_PLANES in the environment ask for other strips, for measuring.
StripSettings choose_strips(const Model& model, Effects effects);

struct LaunchChoice
{
  StepLaunch launch;
  bool resident;  ///< all blocks fit the device at once, so that one launch does many steps
};

/// FRONTALIS_CUDA_RESIDENT=0 in the environment asks for a launch a step, for measuring.
LaunchChoice choose_launch(DeviceModel& device);

}  // namespace cuda
}  // namespace frontalis
