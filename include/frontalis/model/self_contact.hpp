#pragma once

#include "frontalis/model/surface.hpp"

#include <string>

namespace frontalis
{

/// Surfaces of the tissue that touch each other and themselves, with the sides that their triangles face.
struct SelfContact
{
  std::string name;      ///< of the constraint in the scene
  double friction = 0;   ///< Coulomb's coefficient
  TriangleMesh surface;  ///< all these surfaces at rest, local [m]; where two of them join they share vertices
  Binding binding;       ///< of the surface's vertices
};

}  // namespace frontalis
