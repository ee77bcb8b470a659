#include "solver/contact/past_rim.hpp"

#include "frontalis/model/sample_field.hpp"
#include "solver/contact/bone_pose.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace frontalis
{
namespace
{

// Position of a sliding node in the frame of its surface, which is that of the bone at rest.
std::array<double, 3> place_of(const Model& model, const SlidingNode& node, const NodalVectors& displacements,
                               const std::vector<RigidTransform>& bones)
{
  auto p = rest_position(model, node.node);
  for (std::size_t axis = 0; axis < 3; ++axis)
    p[axis] += displacements[node.node][axis];
  const std::int32_t bone = model.constraint_surfaces[node.surface].bone;
  if (bone < 0)
    return p;
  const auto at_rest = pose_of(bones[bone]).inwards({ p[0], p[1], p[2] });
  return { { at_rest.x, at_rest.y, at_rest.z } };
}

}  // namespace

void find_nodes_past_rim(const Model& model, const NodalVectors& displacements,
                         const std::vector<RigidTransform>& bones, Monitor& monitor)
{
  // Allowed distance [m] of a node from the samples of its surface. Beyond the samples the node keeps its last tangent
  // plane. A brick of eight samples, 0.5 mm apart, ends 4 mm past the rim; over that length a plane departs by 0.1 mm
  // from a head, whose radius is about 80 mm.
  constexpr double far = 4e-3;
  for (const SlidingNode& node : model.sliding)
  {
    const SampledField& field = model.constraint_surfaces[node.surface].field;
    const auto p = place_of(model, node, displacements, bones);
    if (has_samples_near(field, p, 0))
      continue;
    ++monitor.past_rim;
    if (!has_samples_near(field, p, far))
      monitor.lost_node = node.node;
  }
}

double farthest_from_level(const Model& model, const NodalVectors& displacements,
                           const std::vector<RigidTransform>& bones)
{
  double farthest = 0;
  for (const SlidingNode& node : model.sliding)
  {
    const SampledField& field = model.constraint_surfaces[node.surface].field;
    const double off = level_at(field, place_of(model, node, displacements, bones)) - node.distance;
    if (!std::isfinite(off))
      return std::numeric_limits<double>::infinity();
    farthest = std::max(farthest, std::abs(off));
  }
  return farthest;
}

double distance_from_rest(const Model& model, std::int32_t node, const NodalVectors& displacements,
                          const std::vector<RigidTransform>& bones)
{
  double nearest = 1e300;
  for (const SlidingNode& own : model.sliding)
    if (own.node == node)
    {
      const auto p = place_of(model, own, displacements, bones);
      for (const SlidingNode& other : model.sliding)
        if (other.surface == own.surface)
        {
          const auto q = rest_position(model, other.node);
          nearest = std::min(nearest, std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]));
        }
    }
  return nearest;
}

}  // namespace frontalis
