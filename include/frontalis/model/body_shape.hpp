#pragma once

#include "frontalis/model/model.hpp"

namespace frontalis
{

/// A bone, or a body that tissue touches, with what a viewer needs to show it.
struct BodyShape
{
  std::string name;              ///< of its constraint, or of the bone
  std::string frame;             ///< name of its frame, below the face frame: body/NAME or bone/NAME
  std::array<double, 3> centre;  ///< origin of that frame at rest, local [m]
  const TriangleMesh* surface =
      nullptr;              ///< surface at rest, local [m], owned by the model; null for bones, may be empty
  bool only_shown = false;  ///< whether no tissue touches it
  std::int32_t bone = -1;   ///< index into Model::bones of the bone that moves it; -1: it stands still
};
/// The shapes of touched_bodies(model), in the same order.
std::vector<BodyShape> body_shapes(const Model& model);
/// One shape per bone, without a surface. Its centre is the point about which the bone turns: the centre of a ball that
/// tissue slides on, else that of the bone's first pose in the action units, expressions and demo, else the middle of
/// the nodes that the bone holds.
std::vector<BodyShape> bone_shapes(const Model& model);

}  // namespace frontalis
