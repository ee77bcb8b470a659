#pragma once

#include "frontalis/effect.hpp"

namespace frontalis
{

/// Effects that a build can leave out (FRONTALIS_WITHOUT_EFFECTS in CMake), so that what the others cost can be
/// compared with a program in which they do not exist.
constexpr bool built_with([[maybe_unused]] Effect effect)
{
#if defined(FRONTALIS_WITHOUT_FIBRE_STIFFNESS)
  if (effect == Effect::fibre_stiffness)
    return false;
#endif
#if defined(FRONTALIS_WITHOUT_CONTRACTION)
  if (effect == Effect::contraction)
    return false;
#endif
#if defined(FRONTALIS_WITHOUT_VISCOSITY)
  if (effect == Effect::viscosity)
    return false;
#endif
#if defined(FRONTALIS_WITHOUT_GRAVITY)
  if (effect == Effect::gravity)
    return false;
#endif
#if defined(FRONTALIS_WITHOUT_SURFACE_LOADS)
  if (effect == Effect::surface_loads)
    return false;
#endif
#if defined(FRONTALIS_WITHOUT_PRESCRIBED_DISPLACEMENT)
  if (effect == Effect::prescribed_displacement)
    return false;
#endif
#if defined(FRONTALIS_WITHOUT_RIGID_NODES)
  if (effect == Effect::rigid_nodes)
    return false;
#endif
#if defined(FRONTALIS_WITHOUT_SLIDING)
  if (effect == Effect::sliding)
    return false;
#endif
#if defined(FRONTALIS_WITHOUT_FRICTION)
  if (effect == Effect::friction)
    return false;
#endif
  return true;
}

/// Throws Error where a model wants an effect that this build leaves out.
inline void check_build(EffectSet wanted)
{
  for (const Effect effect : every_effect())
    if (wanted.has(effect) && !built_with(effect))
      throw Error("the model has " + name_of(effect) + ", which this build was made without");
}

}  // namespace frontalis
