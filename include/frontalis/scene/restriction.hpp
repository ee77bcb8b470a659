#pragma once

#include "frontalis/scene/geometry.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace frontalis
{

/// Data of a body that moves freely under forces instead of along a path.
struct ScenePush
{
  double mass = 0;           ///< [kg]
  Vector3 force{ 0, 0, 0 };  ///< constant force in scene axes [N]
  double spring = 0;         ///< stiffness of the spring that pulls the body to its place on its bone [N/m]
  double damping = 0;        ///< damping force divided by the velocity relative to that place [N s/m]
};

struct SceneConstraint
{
  enum class Kind
  {
    rigid,
    sliding,
    contact,
    self_contact
  };
  std::string name;
  Kind kind = Kind::rigid;
  std::vector<std::string> surfaces;
  double within = -1;           ///< largest distance of restricted nodes outside the surface [m]; < 0: 0.75 voxel edges
  std::vector<std::string> of;  ///< rigid only: holds only nodes of voxels with these muscles; empty: all nodes
  Region crop;
  std::string bone;     ///< bone that moves the rigid nodes or the sliding surface; empty: they are fixed in space
  double friction = 0;  ///< sliding, contact and self_contact: Coulomb friction coefficient
  std::string on;       ///< contact: surface of the tissue that touches; empty: the skin
  std::optional<ScenePush> pushed;  ///< contact only; empty: the body moves with its bone
  int line = 0;

  /// False for contact of tissue with a body or with itself.
  bool restricts_nodes() const { return kind == Kind::rigid || kind == Kind::sliding; }
};

/// Load or prescribed displacement on a surface. It grows linearly from 0 during the first `ramp` seconds.
struct SceneLoad
{
  enum class Kind
  {
    traction,     ///< value: force per area of the undeformed surface [Pa]; its direction is constant
    pressure,     ///< value[0]: pressure [Pa] against the outward normal of the deformed surface
    displacement  ///< value: displacement of nodes near the surface [m]; components not `fixed` are free
  };
  std::string name;
  Kind kind = Kind::traction;
  std::string surface;
  Vector3 value{ 0, 0, 0 };
  std::array<bool, 3> fixed{ true, true, true };
  double within = -1;  ///< displacement only: see SceneConstraint::within
  double ramp = 0;     ///< [s]
  /// Whether the load is multiplied by an activation of its own, which has the load's name, instead of by the ramp.
  bool activated = false;
  Region crop;
  /// Traction and pressure only: triangles with a vertex closer than `clearance` [m] to one of these surfaces carry no
  /// load.
  std::vector<std::string> clear_of;
  double clearance = 0;
  int line = 0;
};

}  // namespace frontalis
