#pragma once

#include "frontalis/model/effects.hpp"
#include "frontalis/solver/solver.hpp"

#include <memory>
#include <string>
#include <vector>

namespace frontalis
{

/// What one effect of a model costs.
struct EffectCost
{
  Effect effect;
  EffectPresence presence;
  std::size_t bytes = 0;  ///< that the solver's arrays hold for it
  double step = 0;    ///< of a step [s]: by the model without it; elasticity: all of a step without any other effect
  double spread = 0;  ///< half of what lies between the quartiles of the differences [s]
};

struct EffectCosts
{
  std::string backend;
  double step = 0;        ///< of the model [s], every muscle at activation 0.75
  double plain_step = 0;  ///< the same voxels, neo-Hookean, nothing else [s]
  double field = 0;       ///< one field of the skin, asked for [s]
  std::vector<EffectCost> effects;
};

/// The same voxels with neo-Hookean materials of the same moduli at rest, one-point integration, scalar hourglass
/// control, and no other effect.
Model plain_model(const Model& model);

/// Times the model against itself without each effect, in turn, for about so many wall seconds each.
EffectCosts measure_effects(const std::shared_ptr<const Model>& model, const SolverSettings& settings, double seconds);

}  // namespace frontalis
