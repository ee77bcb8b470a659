#pragma once

#include "frontalis/model/model.hpp"

namespace frontalis
{

/// A body that tissue touches, as it is shown.
struct BodyShape
{
  std::string name;                       ///< of its constraint, or of the bone
  std::string frame;                      ///< body/NAME or bone/NAME: its frame, below the face frame
  std::array<double, 3> centre;           ///< at rest, local: origin of the frame in which it is published [m]
  const TriangleMesh* surface = nullptr;  ///< of the model, at rest, local [m]; may be empty
};
/// One per entry of touched_bodies(model).
std::vector<BodyShape> body_shapes(const Model& model);
/// One per bone, without a surface. Its centre is the point that the bone turns about: that of a ball that tissue
/// slides on, else that of its first pose in the action units, expressions and demo; else the middle of the nodes that
/// it holds.
std::vector<BodyShape> bone_shapes(const Model& model);

}  // namespace frontalis
