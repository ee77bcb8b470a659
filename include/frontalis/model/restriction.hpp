#pragma once

#include "frontalis/model/surface.hpp"

#include <array>
#include <cstdint>
#include <string>

namespace frontalis
{

struct ConstraintSurface
{
  std::string name;
  TriangleMesh mesh;
  std::int32_t bone = -1;  ///< index into Model::bones of the one it moves with; -1: still
  double friction = 0;     ///< Coulomb's coefficient
};

struct RigidNode
{
  std::int32_t node = 0;
  std::int32_t bone = -1;        ///< index into Model::bones; -1: still
  std::int32_t constraint = -1;  ///< constraint that restricts it, in Model::constraints; -1: unknown
};

struct SlidingNode
{
  std::int32_t node = 0;
  std::int32_t surface = 0;      ///< index into Model::constraint_surfaces
  double distance = 0;           ///< distance to keep from the surface [m], positive on the side of its outward normals
  std::int32_t constraint = -1;  ///< constraint that restricts it, in Model::constraints; -1: unknown
};

struct PrescribedNode
{
  std::int32_t node = 0;
  std::int32_t load = 0;  ///< index into Model::loads
};

/// Load on a bound surface (traction, pressure) or prescribed motion of nodes (displacement).
struct Load
{
  enum class Kind : std::uint8_t
  {
    traction,
    pressure,
    displacement
  };
  std::string name;
  Kind kind = Kind::traction;
  std::array<double, 3> value{};                      ///< local axes; [Pa] (pressure: first component) or [m]
  std::array<bool, 3> fixed{ { true, true, true } };  ///< displacement: which components are prescribed, local axes
  double ramp = 0;                                    ///< [s]
  TriangleMesh mesh;                                  ///< traction and pressure: the surface, at rest
  Binding binding;                                    ///< of the mesh's vertices
};

}  // namespace frontalis
