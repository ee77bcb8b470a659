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
  std::string name;        ///< of the constraint in the scene
  std::int32_t bone = -1;  ///< index into Model::bones of the bone that moves the body; -1: the body stands still
  double friction = 0;     ///< Coulomb's coefficient
  SampledField field;      ///< distance from the body, negative inside
  double reach = 0;        ///< samples are stored at least this far from the surface [m]
  std::array<double, 3> centre{};  ///< origin of the body's published frame at rest, local [m]
  TriangleMesh shape{};            ///< the body's surface at rest, local, to be shown [m]; may be empty

  // A body that is pushed may shift relative to its bone, but turns with it.
  double mass = 0;                ///< [kg]; 0: the body is not pushed, but moves with its bone
  std::array<double, 3> force{};  ///< constant force on the body, local axes [N]
  double spring = 0;              ///< stiffness of the spring to the body's place on its bone [N/m]
  double damping = 0;             ///< damping force divided by the body's velocity relative to that place [N s/m]

  // The points of the tissue stand for the vertices of its surface; the bake merges vertices that are close together.
  std::vector<std::array<double, 3>> points;  ///< at rest, local [m]
  std::vector<double> area;                   ///< area of each point [m2]: the sum of its vertices' areas
  Binding binding;                            ///< one entry per point
};

/// Area of each vertex [m2]: a third of the area of the triangles at it.
std::vector<double> vertex_areas(const TriangleMesh& surface);

/// Sets the points of a contact: the vertices of a bound surface, with their areas.
void set_points(Contact& contact, const TriangleMesh& surface, const Binding& binding);

}  // namespace frontalis
