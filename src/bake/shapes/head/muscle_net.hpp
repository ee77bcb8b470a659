#pragma once

#include "bake/fibres/nurbs_volume.hpp"
#include "bake/mesh/surface_mesh.hpp"
#include "frontalis/scene/tissue.hpp"

namespace frontalis
{

/// The NURBS volume of a control net.
NurbsVolume volume_of(const ControlNet& net);

/// Closed surface of the NURBS volume of a control net, with edges of about `edge` [m].
TriangleMesh net_surface(const ControlNet& net, double edge);

}  // namespace frontalis
