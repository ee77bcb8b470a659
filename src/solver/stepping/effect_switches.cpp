#include "solver/stepping/effect_switches.hpp"

#include <fmt/format.h>

namespace frontalis
{

bool EffectSwitches::change(Effect effect, bool on)
{
  const std::string name = name_of(effect);
  if (traits_of(effect).not_live[0] != '\0')
    throw Error(fmt::format("{} cannot be switched while running: {}", name, traits_of(effect).not_live));
  if (const EffectPresence presence = presence_of(model_, effect); !presence.present)
    throw Error(fmt::format("the model has no {} ({}); it has {}", name, presence.why, names_of(effects_of(model_))));
  if (running_.has(effect) == on)
    return false;
  const EffectSet running = running_.with(effect, on);
  check_needs(running);
  running_ = running;
  return true;
}

std::array<double, 3> EffectSwitches::gravity() const
{
  const MassScalingSettings& scaling = model_.mass_scaling;
  const double scale = scaling.kind == MassScalingSettings::Kind::uniform ? scaling.factor : 1.0;
  std::array<double, 3> result{};
  for (std::size_t axis = 0; axis < 3 && running_.has(Effect::gravity); ++axis)
    result[axis] = model_.gravity[axis] / scale;
  return result;
}

std::vector<float> EffectSwitches::felt(const std::vector<float>& activation) const
{
  if (running_.has(Effect::contraction))
    return activation;
  std::vector<float> acting(activation.size(), 0);
  for (const Load& load : model_.loads)
    if (load.activation >= 0)
      acting[load.activation] = activation[load.activation];
  return acting;
}

Effect effect_of_fibres(const Model& model)
{
  return presence_of(model, Effect::contraction).present ? Effect::contraction : Effect::fibre_stiffness;
}

}  // namespace frontalis
