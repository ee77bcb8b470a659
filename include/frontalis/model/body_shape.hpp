#pragma once

#include "frontalis/model/model.hpp"

namespace frontalis
{

/// A body that tissue touches, as it is shown.
struct BodyShape
{
  std::string name;                       ///< of its constraint
  std::array<double, 3> centre;           ///< at rest, local: origin of the frame in which it is published [m]
  const TriangleMesh* surface = nullptr;  ///< of the model, at rest, local [m]; may be empty
};
/// One per entry of touched_bodies(model).
std::vector<BodyShape> body_shapes(const Model& model);

}  // namespace frontalis
