#pragma once

#include "frontalis/model/effects.hpp"

#include <cstdint>
#include <vector>

namespace frontalis
{

class ModelReader;
class ModelWriter;

/// The functions of an effect that model files, checks and lists of effects call. Each effect has one row in the table
/// of effects.cpp. A null function does nothing.
struct EffectDescription
{
  Effect effect;
  /// Tells whether and where the model has the effect, if it is not switched off.
  EffectPresence (*found)(const Model&);
  /// Removes the effect from the model. `off`: all effects that are being removed.
  void (*remove)(Model&, EffectSet off) = nullptr;
  /// Checks the effect's part of a model; throws Error as check_model() does.
  void (*check)(const Model&) = nullptr;
  /// Write and read the effect's own arrays in a model file.
  void (*write)(ModelWriter&, const Model&) = nullptr;
  void (*read)(ModelReader&, Model&) = nullptr;
  /// Contribute to moving_bones() and touched_bodies().
  void (*set_bones)(const Model&, std::vector<std::int32_t>& bone_of_node) = nullptr;
  void (*add_bodies)(const Model&, std::vector<TouchedBody>& bodies) = nullptr;
};

/// Descriptions of the effects that have a file of their own.
EffectDescription contact_description();
EffectDescription self_contact_description();
EffectDescription attachment_description();
EffectDescription shell_description();
EffectDescription cut_voxels_description();

/// Removes the attached nodes that slide, or those that are held.
void remove_attached(Model& model, bool sliding);

/// Call the functions `write`, `read` or `check` of all effects.
void exchange_effects(ModelWriter& archive, const Model& model);
void exchange_effects(ModelReader& archive, Model& model);
void check_effects(const Model& model);

}  // namespace frontalis
