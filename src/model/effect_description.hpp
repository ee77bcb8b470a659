#pragma once

#include "frontalis/model/effects.hpp"

#include <cstdint>
#include <vector>

namespace frontalis
{

class ModelReader;
class ModelWriter;

/// What the model files, checks and lists of effects know of an effect. Each effect has one row in the table of
/// effects.cpp. Null: there is nothing to do.
struct EffectDescription
{
  Effect effect;
  /// What the model has of the effect, if it is not switched off.
  EffectPresence (*found)(const Model&);
  /// Takes it out of the model. `off`: all effects that are taken out.
  void (*remove)(Model&, EffectSet off) = nullptr;
  /// Throws Error as check_model().
  void (*check)(const Model&) = nullptr;
  /// Its own arrays in the model file.
  void (*write)(ModelWriter&, const Model&) = nullptr;
  void (*read)(ModelReader&, Model&) = nullptr;
  /// See moving_bones() and touched_bodies().
  void (*set_bones)(const Model&, std::vector<std::int32_t>& bone_of_node) = nullptr;
  void (*add_bodies)(const Model&, std::vector<TouchedBody>& bodies) = nullptr;
};

/// The effects that have a file of their own.
EffectDescription contact_description();

/// Calls the `write`, `read` or `check` of all effects.
void exchange_effects(ModelWriter& archive, const Model& model);
void exchange_effects(ModelReader& archive, Model& model);
void check_effects(const Model& model);

}  // namespace frontalis
