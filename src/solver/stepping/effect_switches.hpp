#pragma once

#include "frontalis/model/effects.hpp"

#include <array>
#include <vector>

namespace frontalis
{

/// The effects of a model that are switched on, and the resulting gravity and activations.
class EffectSwitches
{
public:
  explicit EffectSwitches(const Model& model) : model_(model), running_(effects_of(model)) {}

  EffectSet running() const { return running_; }
  /// Switches an effect; returns false if nothing changes. Throws Error if the model does not have the effect, if
  /// another effect needs it, or if it cannot be switched while running.
  bool change(Effect effect, bool on);
  /// Acceleration of gravity for the scaled masses [m/s2]. It is reduced, because uniform mass scaling must not change
  /// weight.
  std::array<double, 3> gravity() const;
  /// Activations that act: those of fibres are 0 while contraction is switched off.
  std::vector<float> felt(const std::vector<float>& activation) const;

private:
  const Model& model_;
  EffectSet running_;
};

/// Whether the effect is one of the two effects of fibres, which contract a voxel and stiffen it.
inline bool is_of_fibres(Effect effect) { return effect == Effect::contraction || effect == Effect::fibre_stiffness; }
/// The effect to which memory for fibres is attributed: contraction if the model has that effect.
Effect effect_of_fibres(const Model& model);

}  // namespace frontalis
