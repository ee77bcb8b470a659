#include "solver/contact/gliding_nodes.hpp"

#include "frontalis/physics/sliding.hpp"

#include <algorithm>

namespace frontalis
{
namespace
{

using Point = SurfaceContact::Point;

Point rotated(const RigidTransform& pose, const Point& p)
{
  const auto& r = pose.rotation;
  return { r[0] * p.x + r[1] * p.y + r[2] * p.z, r[3] * p.x + r[4] * p.y + r[5] * p.z,
           r[6] * p.x + r[7] * p.y + r[8] * p.z };
}

Point rotated_back(const RigidTransform& pose, const Point& p)
{
  const auto& r = pose.rotation;
  return { r[0] * p.x + r[3] * p.y + r[6] * p.z, r[1] * p.x + r[4] * p.y + r[7] * p.z,
           r[2] * p.x + r[5] * p.y + r[8] * p.z };
}

Point translation(const RigidTransform& pose)
{
  return { pose.translation[0], pose.translation[1], pose.translation[2] };
}

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
  const RigidTransform still;
  const auto nodes = range(first, last);
  for (Node* node = nodes_.data() + (nodes.first - nodes_.data()); node != nodes.second; ++node)
  {
    const auto n = node->node;
    // what friction knows of the pressure stays too
    const RigidTransform& now = node->bone < 0 ? still : step.bone[node->bone];
    const RigidTransform& before = node->bone < 0 ? still : step.bone_before[node->bone];
    // in the frame of the bone, relative to it
    Point p = rotated_back(now, node->rest + Point{ u[0][n], u[1][n], u[2][n] } - translation(now));
    const Point moved = rotated(now, p) + translation(now) - rotated(before, p) - translation(before);
    node->surface_velocity = (1 / step.dt) * moved;
    Point w = rotated_back(now, Point{ v[0][n], v[1][n], v[2][n] } - node->surface_velocity);
    double taken = 0;
    if (node->plane.slip < 0 || norm(p - node->reference) > node->plane.slip)
    {
      const Point normal = node->plane.normal;
      node->plane = node->contact.renew(p);
      node->reference = p;
      // what turns it is a part of the reaction
      taken = dot(node->plane.normal, w);
      w = physics::turned_with_normal(normal, node->plane.normal, w);
      taken -= dot(node->plane.normal, w);
    }
    taken += physics::slide(node->plane.normal, node->plane.height, p, w);
    if (rubs_ && node->friction > 0)
    {
      node->pressing += physics::friction_response(step.dt) * (taken / step.dt - node->pressing);
      const Point lost = physics::friction_loss(node->friction, step.dt * node->pressing, norm(w)) * w;
      w = w - lost;
      p = p - step.dt * lost;
    }
    const Point moved_to = rotated(now, p) + translation(now) - node->rest;
    const Point velocity = rotated(now, w) + node->surface_velocity;
    node->normal = rotated(now, node->plane.normal);
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
    const Point change = at(after, n) - at(without, n);
    const Point along = change - dot(change, node->normal) * node->normal;
    lost -= mass[n] * dot(along, 0.5 * (at(before, n) + at(after, n)) - node->surface_velocity);
  }
  return lost;
}

template class GlidingNodes<float>;
template class GlidingNodes<double>;

}  // namespace frontalis
