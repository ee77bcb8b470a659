#include "solver/contact/gliding_nodes.hpp"

#include "frontalis/physics/element/sliding_node.hpp"

#include <algorithm>

namespace frontalis
{
namespace
{

using Point = SurfaceContact::Point;

}  // namespace

template <class Real>
void GlidingNodes<Real>::reset()
{
  for (auto& node : nodes_)
  {
    node.contact.forget();
    node.plane = {};
    node.plane.slip = -1;
    node.pressing = 0;
  }
}

template <class Real>
std::pair<const typename GlidingNodes<Real>::Node*, const typename GlidingNodes<Real>::Node*> GlidingNodes<Real>::range(
    std::int32_t first, std::int32_t last) const
{
  const auto before = [](const Node& a, std::int32_t node) { return a.node < node; };
  const Node* const begin = nodes_.data();
  const Node* const end = begin + nodes_.size();
  return { std::lower_bound(begin, end, first, before), std::lower_bound(begin, end, last, before) };
}

template <class Real>
void GlidingNodes<Real>::apply(std::int32_t first, std::int32_t last, Real* const u[3], Real* const v[3],
                               const ConstraintStep& step)
{
  const auto nodes = range(first, last);
  for (Node* node = nodes_.data() + (nodes.first - nodes_.data()); node != nodes.second; ++node)
  {
    const auto n = node->node;
    const physics::Pose now = node->bone < 0 ? physics::Pose() : pose_of(step.bone[node->bone]);
    const physics::Pose before = node->bone < 0 ? physics::Pose() : pose_of(step.bone_before[node->bone]);
    const physics::RelativeMotion motion = physics::relative_to(
        now, before, 1 / step.dt, node->rest + Point{ u[0][n], u[1][n], u[2][n] }, { v[0][n], v[1][n], v[2][n] });
    node->surface_velocity = motion.surface_velocity;
    Point p = motion.place, w = motion.velocity;
    double taken = 0;
    if (node->plane.slip < 0 || norm(p - node->reference) > node->plane.slip)
    {
      const Point normal = node->plane.normal;
      node->plane = node->contact.renew(p);
      node->reference = p;
      taken = physics::turn_with_plane(normal, node->plane.normal, w);
    }
    taken += physics::slide(node->plane.normal, node->plane.height, p, w);
    if (rubs_ && node->friction > 0)
      physics::rub(node->friction, physics::friction_response(step.dt), step.dt, taken / step.dt, node->pressing, p, w);
    const Point moved_to = now.outwards(p) - node->rest, velocity = now.turned(w) + node->surface_velocity;
    node->normal = now.turned(node->plane.normal);
    const double to[3] = { moved_to.x, moved_to.y, moved_to.z }, speed[3] = { velocity.x, velocity.y, velocity.z };
    for (int axis = 0; axis < 3; ++axis)
    {
      u[axis][n] = static_cast<Real>(to[axis]);
      v[axis][n] = static_cast<Real>(speed[axis]);
    }
  }
}

template <class Real>
double GlidingNodes<Real>::friction_loss(std::int32_t first, std::int32_t last, const std::vector<double>& mass,
                                         const Real* const before[3], const Real* const without[3],
                                         const Real* const after[3]) const
{
  const auto at = [](const Real* const v[3], std::int32_t n) { return Point{ v[0][n], v[1][n], v[2][n] }; };
  double lost = 0;
  const auto nodes = range(first, last);
  for (const Node* node = nodes.first; node != nodes.second; ++node)
  {
    if (!rubs_ || !(node->friction > 0))
      continue;
    const auto n = node->node;
    lost += mass[n] *
            physics::friction_work(node->normal, node->surface_velocity, at(before, n), at(without, n), at(after, n));
  }
  return lost;
}

template class GlidingNodes<float>;
template class GlidingNodes<double>;

}  // namespace frontalis
