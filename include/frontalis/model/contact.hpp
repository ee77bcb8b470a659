#pragma once

#include "frontalis/model/restriction.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace frontalis
{

/// A rigid body that tissue may touch and leave, and the points of the tissue that touch it.
struct Contact
{
  std::string name;        ///< of its constraint
  std::int32_t bone = -1;  ///< index into Model::bones of the one that is the body; -1: it stands still
  double friction = 0;     ///< Coulomb's coefficient
  SampledField field;      ///< distance from the body, negative inside
  double reach = 0;        ///< a point that is farther from the surface than this may have no samples around it [m]

  // vertices of the tissue's surface
  std::vector<std::array<double, 3>> points;  ///< at rest, local [m]
  std::vector<double> area;                   ///< of the surface, a third of each triangle at the vertex [m2]
  Binding binding;                            ///< one entry per point
};

/// Surfaces of the tissue that touch each other and themselves.
struct SelfContact
{
  std::string name;      ///< of its constraint
  double friction = 0;   ///< Coulomb's coefficient
  TriangleMesh surface;  ///< at rest, local; surfaces that join share vertices there
  Binding binding;       ///< of its vertices
};

/// Area of each vertex [m2]: a third of each of its triangles.
std::vector<double> vertex_areas(const TriangleMesh& surface);

/// Sets the points of a contact: the vertices of a bound surface, with their areas.
void set_points(Contact& contact, const TriangleMesh& surface, const Binding& binding);

}  // namespace frontalis
