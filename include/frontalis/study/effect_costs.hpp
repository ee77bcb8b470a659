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

struct EffectCost
{
  Effect effect;
  EffectPresence presence;
  std::size_t bytes = 0;  ///< size of the solver's arrays for this effect
  /// Time per step [s] that the effect adds; for elasticity the time per step of the model without other effects.
  Spread step;
};

struct EffectCosts
{
  std::string backend;
  double step = 0;           ///< time per step with every muscle at `activation` [s]
  double activation = 0.75;  ///< less if it was not reached in the time of the measurement
  double plain_step = 0;     ///< time per step of plain_model() [s]
  double field = 0;          ///< time to compute one field of the skin [s]
  std::vector<EffectCost> effects;
};

/// Returns the model's voxels with neo-Hookean elasticity alone, one-point integration and scalar hourglass control.
Model plain_model(const Model& model);

/// Times the model and copies that each lack one of its effects; `timer` measures the time per step.
EffectCosts measure_effects(const std::shared_ptr<const Model>& model, const SolverSettings& settings,
                            const StepTimer& timer);

/// The cost of an effect that a fraction of the voxels has, or, for sliding and friction, a fraction of the nodes of
/// one side of the block.
struct PresenceCost
{
  Effect effect;
  double share;  ///< fraction of the voxels or nodes, 0..1
  Spread step;   ///< time per step that the effect adds [s]; friction is compared with frictionless sliding
  double base;   ///< time per step without the effect [s]
};

/// Measures a dense block of 64 x 40 x 40 voxels in which a contiguous fraction along y has one effect. Returns an
/// entry for each effect that single voxels or nodes may have and each fraction of presence_shares().
std::vector<PresenceCost> measure_presence(const SolverSettings& settings, double seconds);
std::vector<double> presence_shares();  ///< fractions in measure_presence(), ascending from 0 to 1

/// Seconds per step of a model with its first muscle at activation 0.75 and the others at 0, and with all at 0.75.
struct ActivationCost
{
  double one = 0, all = 0;
  double spread = 0;  ///< half of the interquartile range of `all` - `one` [s]
};
ActivationCost measure_activation(const std::shared_ptr<const Model>& model, const SolverSettings& settings,
                                  const StepTimer& timer);

}  // namespace frontalis
