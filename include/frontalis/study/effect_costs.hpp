#pragma once

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

}  // namespace frontalis
