#include "solver/contact/gliding_nodes.hpp"

#include "frontalis/physics/element/sliding_node.hpp"

#include <algorithm>

namespace frontalis
{

template <class Real>
std::pair<std::size_t, std::size_t> GlidingNodes<Real>::range(std::int32_t first, std::int32_t last) const
{
  const auto at = [&](std::int32_t node)
  {
    const auto before = [](const Node& a, std::int32_t n) { return a.node < n; };
    return static_cast<std::size_t>(std::lower_bound(nodes_.begin(), nodes_.end(), node, before) - nodes_.begin());
  };
  return { at(first), at(last) };
}

template <class Real>
void GlidingNodes<Real>::apply(std::int32_t first, std::int32_t last, Real* const u[3], Real* const v[3],
                               const ConstraintStep& step, States& states) const
{
  const auto [begin, end] = range(first, last);
  for (std::size_t g = begin; g < end; ++g)
  {
    const Node& node = nodes_[g];
    State& state = states[g];
    const auto n = node.node;
    const physics::Pose now = node.bone < 0 ? physics::Pose() : pose_of(step.bone[node.bone]);
    const physics::Pose before = node.bone < 0 ? physics::Pose() : pose_of(step.bone_before[node.bone]);
    const physics::RelativeMotion motion = physics::relative_to(
        now, before, 1 / step.dt, node.rest + Point{ u[0][n], u[1][n], u[2][n] }, { v[0][n], v[1][n], v[2][n] });
    state.surface_velocity = motion.surface_velocity;
    Point p = motion.place, w = motion.velocity;
    double taken = 0;
    physics::LevelPlane<double> plane{};
    if (node.level.plane_at(p, plane))
    {
      taken = physics::turn_with_plane(state.normal, plane.normal, w);
      state.normal = plane.normal;
      state.height = dot(plane.normal, p) - plane.distance;
    }
    taken += physics::slide(state.normal, state.height, p, w);
    if (rubs_ && node.friction > 0)
      physics::rub(node.friction, physics::friction_response(step.dt), step.dt, taken / step.dt, state.pressing, p, w);
    const Point moved_to = now.outwards(p) - node.rest, velocity = now.turned(w) + state.surface_velocity;
    state.outward = now.turned(state.normal);
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
                                         const Real* const after[3], const States& states) const
{
  const auto at = [](const Real* const v[3], std::int32_t n) { return Point{ v[0][n], v[1][n], v[2][n] }; };
  double lost = 0;
  const auto [begin, end] = range(first, last);
  for (std::size_t g = begin; g < end && rubs_; ++g)
    if (nodes_[g].friction > 0)
    {
      const auto n = nodes_[g].node;
      lost += mass[n] * physics::friction_work(states[g].outward, states[g].surface_velocity, at(before, n),
                                               at(without, n), at(after, n));
    }
  return lost;
}

template class GlidingNodes<float>;
template class GlidingNodes<double>;

}  // namespace frontalis
