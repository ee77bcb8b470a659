#pragma once

#include "frontalis/error.hpp"

#include <array>
#include <cstdint>
#include <string>

namespace frontalis
{

/// A part of the physics that can act on tissue. A scene has an effect if its keys require it and do not switch it off.
enum class Effect : std::uint8_t
{
  elasticity,
  fibre_stiffness,
  contraction,
  viscosity,
  gravity,
  surface_loads,
  prescribed_displacement,
  rigid_nodes,
  sliding,
  friction,
  contact,
  self_contact,
  attachment,
  shell,
  cut_voxels,
  output_fields
};

struct EffectTraits
{
  const char* name;
  const char* description;
  const char* not_off;   ///< why a scene cannot switch the effect off; empty if it can
  const char* not_live;  ///< why a running solver cannot switch the effect; empty if it can
};

/// One entry per effect, in the order of the enumeration Effect.
inline constexpr std::array<EffectTraits, 16> effect_traits{ {
    { "elasticity", "materials, and what stabilises their elements", "nothing else holds a voxel together",
      "nothing else holds a voxel together" },
    { "fibre_stiffness", "passive stress along muscle fibres", "", "" },
    { "contraction", "active stress along muscle fibres", "", "" },
    { "viscosity", "Prony series on the isochoric stress", "", "" },
    { "gravity", "weight", "", "" },
    { "surface_loads", "tractions and pressures on surfaces", "", "" },
    { "prescribed_displacement", "nodes that follow a given path", "",
      "nodes that come back would leap to their path" },
    { "rigid_nodes", "nodes held by bones, still or moved", "", "the tissue would come off its bones" },
    { "sliding", "nodes that keep their distance from a surface", "", "" },
    { "friction", "of sliding nodes, after Coulomb", "", "" },
    { "contact", "rigid bodies that tissue touches and leaves, with friction", "", "" },
    { "self_contact", "surfaces of the tissue that touch each other, with friction", "", "" },
    { "attachment", "nodes near bones that follow others, so that tissue is attached at the surface of the bone", "",
      "the tissue would come off its bones" },
    { "shell", "layers thinner than a voxel, with stiffness in their surface and in bending", "", "" },
    { "cut_voxels", "voxels that tissue fills in part, with the stress at the centroid of the tissue", "",
      "their stress would leap" },
    { "output_fields", "strain and stress of the skin", "", "it is computed only where somebody asks for it" },
} };

class EffectSet
{
public:
  constexpr EffectSet() = default;
  static constexpr EffectSet all()
  {
    EffectSet set;
    set.bits_ = (1u << effect_traits.size()) - 1;
    return set;
  }
  constexpr bool has(Effect effect) const { return (bits_ & bit(effect)) != 0; }
  constexpr bool empty() const { return bits_ == 0; }
  constexpr EffectSet with(Effect effect, bool on = true) const
  {
    EffectSet set = *this;
    set.bits_ = on ? bits_ | bit(effect) : bits_ & ~bit(effect);
    return set;
  }
  /// The effects of this set that are not in the other set.
  constexpr EffectSet without(EffectSet other) const
  {
    EffectSet set = *this;
    set.bits_ &= ~other.bits_;
    return set;
  }
  constexpr bool operator==(EffectSet other) const { return bits_ == other.bits_; }
  constexpr bool operator!=(EffectSet other) const { return bits_ != other.bits_; }

private:
  static constexpr std::uint32_t bit(Effect effect) { return 1u << static_cast<unsigned>(effect); }

  std::uint32_t bits_ = 0;
};

/// All effects, to loop over.
constexpr std::array<Effect, effect_traits.size()> every_effect()
{
  std::array<Effect, effect_traits.size()> effects{};
  for (std::size_t e = 0; e < effects.size(); ++e)
    effects[e] = static_cast<Effect>(e);
  return effects;
}

constexpr const EffectTraits& traits_of(Effect effect) { return effect_traits[static_cast<std::size_t>(effect)]; }
inline std::string name_of(Effect effect) { return traits_of(effect).name; }

/// The names of the effects in a set, separated by commas.
inline std::string names_of(EffectSet set)
{
  std::string text;
  for (const Effect effect : every_effect())
    if (set.has(effect))
      text += (text.empty() ? "" : ", ") + name_of(effect);
  return text;
}

/// The effect of this name. Throws an Error that lists the existing names if there is none.
inline Effect effect_from_name(const std::string& name)
{
  for (const Effect effect : every_effect())
    if (name == name_of(effect))
      return effect;
  throw Error("there is no effect '" + name + "'; the effects are " + names_of(EffectSet::all()));
}

/// Throws an Error with the reason if an effect of the set needs another one that is not in the set.
inline void check_needs(EffectSet set)
{
  if (set.has(Effect::friction) && !set.has(Effect::sliding))
    throw Error("friction needs sliding: switch friction off too, or sliding on");
}

/// Throws an Error with the reason if a scene with the effects `present` cannot switch off the effects in `off`.
inline void check_switched_off(EffectSet off, EffectSet present)
{
  for (const Effect effect : every_effect())
    if (off.has(effect) && traits_of(effect).not_off[0] != '\0')
      throw Error(name_of(effect) + " cannot be switched off: " + traits_of(effect).not_off);
  check_needs(present.without(off));
}

}  // namespace frontalis
