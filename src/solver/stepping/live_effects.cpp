#include "frontalis/error.hpp"
#include "frontalis/model/effects.hpp"
#include "solver/stepping/stepping_solver.hpp"

#include <chrono>

namespace frontalis
{

std::vector<float> SteppingSolver::felt_activation() const
{
  return runs(Effect::contraction) ? activation_ : std::vector<float>(activation_.size(), 0);
}

Effect SteppingSolver::effect_of_fibres() const
{
  return presence_of(*model_, Effect::contraction).present ? Effect::contraction : Effect::fibre_stiffness;
}

void SteppingSolver::set_gravity()
{
  const double scale =
      model_->mass_scaling.kind == MassScalingSettings::Kind::uniform ? model_->mass_scaling.factor : 1.0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    gravity_[axis] = runs(Effect::gravity) ? model_->gravity[axis] / scale : 0;
}

void SteppingSolver::switch_effect(Effect effect, bool on)
{
  const std::string name = name_of(effect);
  if (traits_of(effect).not_live[0] != '\0')
    throw Error(name + " cannot be switched while running: " + traits_of(effect).not_live);
  if (const EffectPresence presence = presence_of(*model_, effect); !presence.present)
    throw Error("the model has no " + name + " (" + presence.why + "); it has " + names_of(effects_of(*model_)));
  if (runs(effect) == on)
    return;
  const EffectSet running = effects_.with(effect, on);
  check_needs(running);
  effects_ = running;
  set_gravity();
  const bool of_fibres = effect == Effect::contraction || effect == Effect::fibre_stiffness;
  if (of_fibres)
    discretisation_.bound(effects_);
  effect_switched(effect);
  if (failed_)
    return;
  if (of_fibres)
    displacements_were_set();
  else
    velocities_were_set();
}

void SteppingSolver::skin_field(SkinField field, std::vector<float>& out)
{
  const auto start = std::chrono::steady_clock::now();
  if (const EffectPresence fields = presence_of(*model_, Effect::output_fields); !fields.present)
    throw Error("the model has no output_fields: " + fields.why);
  if (!skin_values_)
    skin_values_ = std::make_unique<SkinValues>(*model_, discretisation_);
  Vectors u;
  displacements(u);
  skin_values_->compute(field, u, felt_activation(), effects_, out);
  profile_.skin += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::vector<Allocation> SteppingSolver::allocations() const
{
  AllocationList list;
  if (skin_values_)
    skin_values_->list_allocations(list);
  discretisation_.list_allocations(list);
  list.add(Effect::elasticity, "mode of the highest frequency", assembled_mode_);
  list_allocations(list);
  return list.take();
}

}  // namespace frontalis
