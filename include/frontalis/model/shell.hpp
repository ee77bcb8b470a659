#pragma once

#include "frontalis/model/surface.hpp"

#include <string>

namespace frontalis
{

/// A layer of the tissue that is a shell: thinner than the voxels that carry it, with membrane and bending stiffness of
/// its own. The shell has no mass, because the mass of the voxels includes the layer.
struct Shell
{
  std::string name;           ///< of the layer in the scene
  double thickness = 0;       ///< [m]
  std::int32_t material = 0;  ///< index into Model::materials, of which only the stiffness at rest counts
  /// middle surface of the layer in its shape without bending moments: its shape at rest, or with the creases of
  /// add_creases(); local [m]; its edges are about as long as a voxel's
  TriangleMesh surface;
  Binding binding;  ///< binding of the surface's vertices
};

}  // namespace frontalis
