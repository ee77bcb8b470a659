#pragma once

#include "frontalis/effect.hpp"
#include "frontalis/solver/solver.hpp"

#include <memory>
#include <vector>

namespace frontalis
{

/// What an effect costs a step where a share of the voxels (of the nodes of a face: sliding, friction) has it.
struct PresenceCost
{
  Effect effect;
  double share;   ///< of voxels or nodes, 0..1
  double step;    ///< more than without it (friction: than a face that slides) [s]
  double spread;  ///< half of what lies between the quartiles [s]
  double base;    ///< of a step without it [s]
};

/// A dense block of 64 x 40 x 40 voxels of which contiguous shares of 0, 10, 50 and 100 % along y have one effect,
/// timed in turn for about so many wall seconds an effect.
std::vector<PresenceCost> measure_presence(const SolverSettings& settings, double seconds);

/// Seconds a step of a model with its first muscle at activation 0.75 and the others at 0, and with all at 0.75.
struct ActivationCost
{
  double one = 0, all = 0;
  double spread = 0;  ///< of the difference
};
ActivationCost measure_activation(const std::shared_ptr<const Model>& model, const SolverSettings& settings,
                                  double seconds);

}  // namespace frontalis
