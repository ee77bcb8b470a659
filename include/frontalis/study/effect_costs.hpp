#pragma once

#include "frontalis/effect.hpp"
#include "frontalis/model/effects.hpp"
#include "frontalis/solver/solver.hpp"
#include "frontalis/study/step_time.hpp"

#include <memory>
#include <string>
#include <vector>

namespace frontalis
{

/// The cost of one effect of a model.
struct EffectCost
{
  Effect effect;
  EffectPresence presence;
  std::size_t bytes = 0;  ///< size of the solver's arrays for it
  /// Time per step [s] that the effect adds: with it less without it. For elasticity, which every model needs: the time
  /// per step without all other effects.
  Spread step;
};

struct EffectCosts
{
  std::string backend;
  double step = 0;        ///< time per step with every muscle at activation 0.75 [s]
  double plain_step = 0;  ///< time per step of plain_model() [s]
  double field = 0;       ///< time to compute one field of the skin [s]
  std::vector<EffectCost> effects;
};

/// The same voxels with neo-Hookean materials of the same moduli at rest, one-point integration, scalar hourglass
/// control, and no effect but elasticity.
Model plain_model(const Model& model);

/// Compares the model with itself without each of its effects; `timer` measures the time per step.
EffectCosts measure_effects(const std::shared_ptr<const Model>& model, const SolverSettings& settings,
                            const StepTimer& timer);

/// The cost of an effect in a model of which a share has it: of the voxels, or, of sliding and friction, of the nodes
/// of a face.
struct PresenceCost
{
  Effect effect;
  double share;  ///< 0..1
  Spread step;   ///< of a step [s], more than without the effect (friction: more than of a face that slides)
  double base;   ///< of a step without it [s]
};

/// A dense block of 64 x 40 x 40 voxels of which contiguous shares along y have one effect: for each effect that voxels
/// or nodes may have, one entry for each of presence_shares().
std::vector<PresenceCost> measure_presence(const SolverSettings& settings, double seconds);
std::vector<double> presence_shares();  ///< ascending from 0 to 1

/// Seconds per step of a model with its first muscle at activation 0.75 and the others at 0, and with all at 0.75.
struct ActivationCost
{
  double one = 0, all = 0;
  double spread = 0;  ///< of the difference
};
ActivationCost measure_activation(const std::shared_ptr<const Model>& model, const SolverSettings& settings,
                                  const StepTimer& timer);

}  // namespace frontalis
