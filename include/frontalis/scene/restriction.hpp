#pragma once

#include "frontalis/scene/geometry.hpp"

#include <array>
#include <string>
#include <vector>

namespace frontalis
{

struct SceneConstraint
{
  enum class Kind
  {
    rigid,
    sliding,
    contact
  };
  std::string name;
  Kind kind = Kind::rigid;
  std::vector<std::string> surfaces;
  double within = -1;  ///< nodes at most this far outside the surface are restricted [m]; < 0: 0.75 voxel edges
  Region crop;
  std::string bone;     ///< rigid nodes, or the surface that nodes slide on, follow this bone; empty: they stand still
  double friction = 0;  ///< sliding and contact: Coulomb's coefficient
  std::string on;       ///< contact: the surface of the tissue that touches; empty: the skin's
  int line = 0;
};

/// Load or prescribed motion on a named surface; all ramp linearly from 0 over `ramp` seconds.
struct SceneLoad
{
  enum class Kind
  {
    traction,     ///< value: force per area of the surface at rest [Pa], of constant direction
    pressure,     ///< value[0]: pressure [Pa] against the outward normal of the deformed surface
    displacement  ///< value: displacement [m] of the nodes near the surface; components not in `fixed` stay free
  };
  std::string name;
  Kind kind = Kind::traction;
  std::string surface;
  Vector3 value{ 0, 0, 0 };
  std::array<bool, 3> fixed{ true, true, true };
  double within = -1;  ///< displacement only, as for constraints
  double ramp = 0;     ///< [s]
  Region crop;
  int line = 0;
};

}  // namespace frontalis
