#pragma once

#include "frontalis/model/effects.hpp"

#include <array>
#include <vector>

namespace frontalis
{

/// Those of a model's effects that run, and what follows from them for gravity and muscles.
class EffectSwitches
{
public:
  explicit EffectSwitches(const Model& model) : model_(model), running_(effects_of(model)) {}

  EffectSet running() const { return running_; }
  /// False where nothing changes. Throws Error where the model does not have the effect, where another needs it, or
  /// where it cannot be switched while running.
  bool change(Effect effect, bool on);
  /// [m/s2] on the masses as they are scaled: uniform mass scaling changes no weight.
  std::array<double, 3> gravity() const;
  /// Activations as fibres feel them.
  std::vector<float> felt(const std::vector<float>& activation) const;

private:
  const Model& model_;
  EffectSet running_;
};

/// Fibres stiffen a voxel and draw it together.
inline bool is_of_fibres(Effect effect) { return effect == Effect::contraction || effect == Effect::fibre_stiffness; }
/// The effect whose memory fibres are: contraction where the model has it.
Effect effect_of_fibres(const Model& model);

}  // namespace frontalis
