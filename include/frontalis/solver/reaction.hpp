#pragma once

#include <array>

namespace frontalis
{

/// What tissue does to a rigid body that it touches, local axes.
struct Reaction
{
  std::array<double, 3> force{};   ///< [N]
  std::array<double, 3> moment{};  ///< [N m] about the origin of the local frame where the body has carried it
};

}  // namespace frontalis
