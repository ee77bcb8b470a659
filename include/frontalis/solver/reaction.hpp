#pragma once

#include <array>

namespace frontalis
{

/// Force and moment of the tissue on a rigid body that touches it, local axes.
struct Reaction
{
  std::array<double, 3> force{};   ///< [N]
  std::array<double, 3> moment{};  ///< [N m] about the body's point that rests at the origin of the local frame
};

}  // namespace frontalis
