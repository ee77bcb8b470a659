#pragma once

#include "frontalis/effect.hpp"
#include "frontalis/model/model.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace frontalis
{

/// Whether and where a model has an effect.
struct EffectPresence
{
  bool present = false;
  std::string why;         ///< why it is present or not, in a few words
  std::size_t voxels = 0;  ///< number of voxels that the effect acts on; 0 if it acts on nodes
  std::size_t nodes = 0;   ///< number of nodes that the effect acts on; 0 if it acts on voxels
};

/// Tells whether a model has an effect; no other function decides this.
EffectPresence presence_of(const Model& model, Effect effect);
EffectSet effects_of(const Model& model);

/// Whether one of the voxel's materials is viscous.
bool is_viscous(const Model& model, std::size_t voxel);
/// Whether the voxel contains tissue of a law other than neo-Hookean.
bool has_law(const Model& model, std::size_t voxel);

/// A rigid body. Either tissue may touch and push it, or it is only shown (BodyShape::only_shown).
struct TouchedBody
{
  std::string name;
  std::int32_t bone = -1;  ///< index into Model::bones of the bone that moves the body; -1: the body stands still
};
/// All rigid bodies of the model, in the order of Solver::reactions().
std::vector<TouchedBody> touched_bodies(const Model& model);

/// Numbers of restricted nodes, of all or of those of one constraint: "rigid 3, sliding 5, attached 7"; attached ones
/// only if there are any.
std::string restricted_nodes_text(const Model& model, std::int32_t constraint = -1);

/// For each node, the index of a bone that may move it; -1: none.
std::vector<std::int32_t> moving_bones(const Model& model);

/// Removes effects from a model, so that nothing is stored for them, and adds their names to Model::switched_off.
/// Throws Error if the effects cannot be removed (check_switched_off()).
void switch_off(Model& model, EffectSet off);

}  // namespace frontalis
