#pragma once

#include "frontalis/model/surface.hpp"

#include <string>

namespace frontalis
{

/// Surfaces of the tissue that touch each other and themselves. Each triangle faces the side on which it is touched.
struct SelfContact
{
  std::string name;      ///< of the constraint in the scene
  double friction = 0;   ///< Coulomb's coefficient
  TriangleMesh surface;  ///< all touching surfaces at rest, local [m]; surfaces that join share vertices
  Binding binding;       ///< of the surface's vertices
};

}  // namespace frontalis
