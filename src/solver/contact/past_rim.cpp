#include "solver/contact/past_rim.hpp"

#include "frontalis/model/sample_field.hpp"
#include "solver/contact/gliding_nodes.hpp"

namespace frontalis
{

void find_nodes_past_rim(const Model& model, const NodalVectors& displacements,
                         const std::vector<RigidTransform>& bones, Monitor& monitor)
{
  // Allowed distance [m] of a node from the samples of its surface. Beyond the samples the node keeps its last tangent
  // plane. A brick of eight samples, 0.5 mm apart, ends 4 mm past the rim; over that length a plane departs by 0.1 mm
  // from a head, whose radius is about 80 mm.
  constexpr double far = 4e-3;
  for (const SlidingNode& node : model.sliding)
  {
    const ConstraintSurface& surface = model.constraint_surfaces[node.surface];
    auto p = rest_position(model, node.node);
    for (std::size_t axis = 0; axis < 3; ++axis)
      p[axis] += displacements[node.node][axis];
    if (surface.bone >= 0)
    {
      const auto at_rest = pose_of(bones[surface.bone]).inwards({ p[0], p[1], p[2] });
      p = { { at_rest.x, at_rest.y, at_rest.z } };
    }
    if (has_samples_near(surface.field, p, 0))
      continue;
    ++monitor.past_rim;
    if (!has_samples_near(surface.field, p, far))
      monitor.lost_node = node.node;
  }
}

}  // namespace frontalis
