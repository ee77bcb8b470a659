#pragma once

#include "frontalis/model/surface.hpp"
#include "frontalis/physics/distance_field.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace frontalis
{

/// Signed distance from a surface where nodes may slide along it, in local coordinates at rest: storage for the arrays
/// of a physics::DistanceField, which documents them. See model/sample_field.hpp.
struct SampledField
{
  std::array<double, 3> origin{ { 0, 0, 0 } };
  double spacing = 0;
  double radius = 0;
  std::array<std::int32_t, 3> bricks{ { 0, 0, 0 } };
  std::vector<std::int32_t> table;
  std::vector<float> samples;
};

struct ConstraintSurface
{
  std::string name;
  std::int32_t bone = -1;  ///< index into Model::bones of the bone that it moves with; -1: it stands still
  double friction = 0;     ///< Coulomb's coefficient
  SampledField field;
};

struct RigidNode
{
  std::int32_t node = 0;
  std::int32_t bone = -1;        ///< index into Model::bones; -1: it stands still
  std::int32_t constraint = -1;  ///< constraint that restricts it, in Model::constraints; -1: unknown
};

struct SlidingNode
{
  std::int32_t node = 0;
  std::int32_t surface = 0;      ///< index into Model::constraint_surfaces
  double distance = 0;           ///< value of the surface's field at rest, kept while the node slides [m]
  std::int32_t constraint = -1;  ///< constraint that restricts it, in Model::constraints; -1: unknown
};

/// Node near the surface of a bone or beyond it, whose motion is extrapolated from that of a free node, its master, so
/// that tissue is attached at the surface itself and not where the node happens to be. A held node's displacement
/// relative to the bone is `ratio` times its master's. A sliding node's distance from the surface is `ratio` times its
/// master's; along the surface it is free.
struct AttachedNode
{
  std::int32_t node = 0;
  std::int32_t master = 0;       ///< a node that is not restricted; it may have several such nodes
  double ratio = 0;              ///< node's over master's distance from the surface at rest, -1..1; negative beyond it
  std::int32_t bone = -1;        ///< of a held node: index into Model::bones; -1: it stands still
  std::int32_t surface = -1;     ///< of a sliding node: index into Model::constraint_surfaces; -1: the node is held
  std::int32_t constraint = -1;  ///< constraint that attaches it, in Model::constraints; -1: unknown
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
