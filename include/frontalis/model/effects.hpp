#pragma once

#include "frontalis/effect.hpp"
#include "frontalis/model/model.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace frontalis
{

/// What a model has of an effect.
struct EffectPresence
{
  bool present = false;
  std::string why;         ///< why it is there or not, in a few words
  std::size_t voxels = 0;  ///< that have it; 0 where it acts on nodes
  std::size_t nodes = 0;   ///< that have it; 0 where it acts on voxels
};

/// The one place that says which effects a model has.
EffectPresence presence_of(const Model& model, Effect effect);
EffectSet effects_of(const Model& model);

/// Whether one of its materials is viscous.
bool is_viscous(const Model& model, std::size_t voxel);

/// Takes effects out of a model, so that nothing is stored for them, and notes their names in Model::switched_off.
/// Throws Error as check_switched_off.
void switch_off(Model& model, EffectSet off);

}  // namespace frontalis
