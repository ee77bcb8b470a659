#pragma once

#include "frontalis/model/surface.hpp"
#include "frontalis/physics/distance_field.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace frontalis
{

/// Signed distance from a surface on which nodes slide or that tissue touches, in local coordinates at rest. Owns the
/// arrays of a physics::DistanceField, which documents them. The functions of model/sample_field.hpp make such fields.
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
  std::int32_t bone = -1;  ///< index into Model::bones of the bone that moves the surface; -1: it stands still
  double friction = 0;     ///< Coulomb's coefficient
  SampledField field;
};

struct RigidNode
{
  std::int32_t node = 0;
  std::int32_t bone = -1;        ///< index into Model::bones of the bone that holds the node; -1: it stands still
  std::int32_t constraint = -1;  ///< constraint that restricts the node, in Model::constraints; -1: unknown
};

struct SlidingNode
{
  std::int32_t node = 0;
  std::int32_t surface = 0;      ///< index into Model::constraint_surfaces
  double distance = 0;           ///< value of the surface's field at the node at rest, kept while the node slides [m]
  std::int32_t constraint = -1;  ///< constraint that restricts the node, in Model::constraints; -1: unknown
};

/// A node near the surface of a bone or beyond it. Its motion is extrapolated from that of a free node, its master, so
/// that the tissue is attached at the surface itself rather than at the position of the node. The displacement of a
/// held node relative to the bone is `ratio` times its master's displacement. The distance of a sliding node from the
/// surface is `ratio` times its master's distance; along the surface the node is free.
struct AttachedNode
{
  std::int32_t node = 0;
  std::int32_t master = 0;  ///< a free node; several attached nodes may have the same master
  /// the node's distance from the surface at rest divided by its master's, -1..1; negative beyond the surface
  double ratio = 0;
  std::int32_t bone = -1;        ///< of a held node: index into Model::bones; -1: the node stands still
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
  /// index into Model::muscles of the activation that a traction or pressure is multiplied by; -1: it grows over the
  /// ramp
  std::int32_t activation = -1;
  TriangleMesh mesh;  ///< traction and pressure: the surface, at rest
  Binding binding;    ///< binding of the mesh's vertices
};

}  // namespace frontalis
