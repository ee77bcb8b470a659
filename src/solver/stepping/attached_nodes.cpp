#include "solver/stepping/attached_nodes.hpp"

#include "frontalis/model/sample_field.hpp"
#include "frontalis/physics/sliding.hpp"
#include "solver/contact/gliding_nodes.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

using Point = physics::Vec3<double>;

template <class Real>
Point point_of(Real* const a[3], std::int32_t n)
{
  return { double(a[0][n]), double(a[1][n]), double(a[2][n]) };
}

template <class Real>
void put(const Point& p, Real* const to[3], std::int32_t n)
{
  to[0][n] = static_cast<Real>(p.x);
  to[1][n] = static_cast<Real>(p.y);
  to[2][n] = static_cast<Real>(p.z);
}

/// Equation for the velocity of a master, mass * velocity = momentum, with sums over the master and the nodes that
/// follow it.
struct Balance
{
  double mass[3][3] = {};
  double momentum[3] = {};

  void add(double m, const Point& v)
  {
    for (int axis = 0; axis < 3; ++axis)
      mass[axis][axis] += m;
    add_momentum(m, v);
  }
  void add_momentum(double m, const Point& v)
  {
    momentum[0] += m * v.x;
    momentum[1] += m * v.y;
    momentum[2] += m * v.z;
  }
  /// Adds a mass that follows the master along one direction only, with dot(direction, velocity) = speed.
  void add(double m, const Point& direction, double speed)
  {
    const double d[3] = { direction.x, direction.y, direction.z };
    for (int i = 0; i < 3; ++i)
    {
      momentum[i] += m * speed * d[i];
      for (int j = 0; j < 3; ++j)
        mass[i][j] += m * d[i] * d[j];
    }
  }
  void fix(int axis, double velocity)
  {
    for (int i = 0; i < 3; ++i)
    {
      momentum[i] -= mass[i][axis] * velocity;
      mass[i][axis] = mass[axis][i] = 0;
    }
    mass[axis][axis] = 1;
    momentum[axis] = velocity;
  }
  /// Solves the equation by elimination; the matrix is symmetric and positive definite.
  Point velocity()
  {
    for (int p = 0; p < 3; ++p)
      for (int i = p + 1; i < 3; ++i)
      {
        const double factor = mass[i][p] / mass[p][p];
        for (int j = p; j < 3; ++j)
          mass[i][j] -= factor * mass[p][j];
        momentum[i] -= factor * momentum[p];
      }
    for (int p = 2; p >= 0; --p)
    {
      for (int j = p + 1; j < 3; ++j)
        momentum[p] -= mass[p][j] * momentum[j];
      momentum[p] /= mass[p][p];
    }
    return { momentum[0], momentum[1], momentum[2] };
  }
};

}  // namespace

/// Poses of bones in a step.
template <class Real>
struct AttachedNodes<Real>::Bones
{
  std::vector<physics::Pose> now, before;  // one per bone; the last entry is a pose that stands still
  double dt;

  explicit Bones(const ConstraintStep& step) : dt(step.dt)
  {
    for (const RigidTransform& bone : step.bone)
      now.push_back(pose_of(bone));
    for (const RigidTransform& bone : step.bone_before)
      before.push_back(pose_of(bone));
    now.emplace_back();
    before.emplace_back();
  }
  std::size_t index(std::int32_t bone) const { return bone < 0 ? now.size() - 1 : static_cast<std::size_t>(bone); }
  /// Displacement, at the end of the step, and velocity of the point of a bone that rests at p.
  Point displacement(std::int32_t bone, const Point& p) const { return now[index(bone)].outwards(p) - p; }
  Point velocity(std::int32_t bone, const Point& p) const
  {
    const std::size_t b = index(bone);
    return (1 / dt) * (now[b].outwards(p) - before[b].outwards(p));
  }
};

template <class Real>
AttachedNodes<Real>::AttachedNodes(const Model& model, const std::vector<double>& mass, AttachKernel<Real> kernel)
    : model_(model), mass_(mass), blocks_(model, mass, kernel)
{
  for (const ConstraintSurface& surface : model.constraint_surfaces)
    fields_.push_back(view(surface.field));
  std::vector<std::array<bool, 3>> fixed(model.nodes.size(), { { false, false, false } });
  for (const PrescribedNode& node : model.prescribed)
    for (std::size_t axis = 0; axis < 3; ++axis)
      fixed[node.node][axis] = fixed[node.node][axis] || model.loads[node.load].fixed[axis];
  std::vector<AttachedNode> nodes = model.attached;
  for (const Model::Joint& joint : model.joints)
    nodes.push_back({ joint.node, joint.master, 1, -1, -1, -1 });
  std::stable_sort(nodes.begin(), nodes.end(),
                   [](const AttachedNode& a, const AttachedNode& b) { return a.master < b.master; });
  for (std::size_t begin = 0, end = 0; begin < nodes.size(); begin = end)
  {
    while (end < nodes.size() && nodes[end].master == nodes[begin].master)
      ++end;
    const auto& path = fixed[nodes[begin].master];
    if (path[0] || path[1] || path[2] || !blocks_.add_group(nodes.data() + begin, nodes.data() + end))
      add_group(nodes.data() + begin, nodes.data() + end, path);
  }
  blocks_.finish();
  reset();
}

template <class Real>
void AttachedNodes<Real>::add_group(const AttachedNode* begin, const AttachedNode* end,
                                    const std::array<bool, 3>& fixed)
{
  const std::int32_t master = begin->master;
  const auto position = [&] { return static_cast<std::int32_t>(ties_.size()); };
  Group group{ master, position(), 0, { fixed[0], fixed[1], fixed[2] } };
  const auto master_planes = static_cast<std::int32_t>(planes_.size());
  std::vector<std::int32_t> surfaces;  // the surface of each of the master's planes
  for (const AttachedNode* node = begin; node != end; ++node)
    if (node->surface >= 0 && std::find(surfaces.begin(), surfaces.end(), node->surface) == surfaces.end())
    {
      surfaces.push_back(node->surface);
      planes_.emplace_back();
    }
  for (const AttachedNode* node = begin; node != end; ++node)
  {
    Tie tie{ node->node, node->bone,  node->surface,     -1,
             -1,         node->ratio, mass_[node->node], rest_point(model_, node->node),
             0 };
    if (node->surface >= 0)
    {
      tie.bone = model_.constraint_surfaces[node->surface].bone;
      const auto known = std::find(surfaces.begin(), surfaces.end(), node->surface) - surfaces.begin();
      tie.master_plane = master_planes + static_cast<std::int32_t>(known);
      tie.plane = static_cast<std::int32_t>(planes_.size());
      planes_.emplace_back();
      tie.offset = level_offset(model_, *node);
    }
    ties_.push_back(tie);
  }
  group.end = position();
  groups_.push_back(group);
}

template <class Real>
void AttachedNodes<Real>::reset()
{
  blocks_.reset();
  std::fill(planes_.begin(), planes_.end(), Plane());
}

template <class Real>
void AttachedNodes<Real>::list_arrays(ArrayList& list)
{
  blocks_.list_arrays(list);
  list.add(Effect::attachment, "masters of attached nodes", groups_);
  list.add(Effect::attachment, "attached nodes", ties_);
  list.add_state(Effect::attachment, "tangent planes", planes_);
}

template <class Real>
void AttachedNodes<Real>::constrain_groups(const NodeShare& share, Real* const u[3], Real* const v[3],
                                           const ConstraintStep& step)
{
  blocks_.constrain(share, u, v, step.dt);
  if (groups_.empty())
    return;
  const auto before = [](const Group& group, std::int32_t node) { return group.master < node; };
  const auto begin = std::lower_bound(groups_.begin(), groups_.end(), share.first_node, before),
             end = std::lower_bound(begin, groups_.end(), share.end_node, before);
  const Bones bones(step);
  for (auto group = begin; group != end; ++group)
    follow_on_bones(*group, u, v, bones);
}

// Linearises the level at `place` if `place` is outside the range of the present plane. Where the field ends or its
// gradient is too short, the present plane is kept.
template <class Real>
void AttachedNodes<Real>::renew(Plane& plane, std::int32_t surface, const Point& place) const
{
  const Point way = place - plane.place;
  if (dot(way, way) <= plane.slip_squared)
    return;
  const physics::DistanceField& field = fields_[surface];
  physics::FieldValue<double> value{};
  physics::LevelPlane<double> level{};
  if (!sample(field, field_point(field, place), value) || !level_plane(value, 0.0, level))
    return;
  plane = { value.gradient, place, value.value, level.slip * level.slip };
}

// Finds the velocity of the master that minimises the sum over the group of mass times |v - v*|^2, where v* and v are
// the velocities of a node before and after the constraints. A held node contributes its mass along all axes, a sliding
// node along the gradient of its master's level.
template <class Real>
void AttachedNodes<Real>::follow_on_bones(const Group& group, Real* const u[3], Real* const v[3], const Bones& bones)
{
  const std::int32_t m = group.master;
  const Point rest = rest_point(model_, m), u_m = point_of(u, m), v_m = point_of(v, m), place_m = rest + u_m;
  // Motion of a sliding node or of its master relative to the surface.
  struct Relative
  {
    Point gradient;  // gradient of the level, in the scene's axes
    Point surface_velocity;
    double level;
  };
  const auto relative = [&](std::int32_t plane, const Tie& tie, const Point& place)
  {
    const physics::Pose& pose = bones.now[bones.index(tie.bone)];
    const Point p = pose.inwards(place);
    Plane& at = planes_[plane];
    renew(at, tie.surface, p);
    return Relative{ pose.turned(at.gradient), bones.velocity(tie.bone, p), at.level_at(p) };
  };

  Balance balance;
  balance.add(mass_[m], v_m);
  for (auto t = group.begin; t < group.end; ++t)
  {
    const Tie& tie = ties_[t];
    const double r = tie.ratio;
    const Point v_s = point_of(v, tie.node);
    if (tie.surface < 0)
    {
      // Relative to the bone, the velocity of the held node is r times that of the master.
      const Point apart = v_s - bones.velocity(tie.bone, tie.rest);
      balance.add(r * r * tie.mass, bones.velocity(tie.bone, rest));
      balance.add_momentum(r * tie.mass, apart);
      continue;
    }
    const Relative s = relative(tie.plane, tie, tie.rest + point_of(u, tie.node));
    const Relative at_m = relative(tie.master_plane, tie, place_m);
    const double steepness = dot(s.gradient, s.gradient);
    if (!(steepness > 0))
      continue;
    balance.add(tie.mass / steepness, r * at_m.gradient,
                dot(s.gradient, v_s - s.surface_velocity) + r * dot(at_m.gradient, at_m.surface_velocity));
  }
  const double kept[3] = { v_m.x, v_m.y, v_m.z };
  for (int axis = 0; axis < 3; ++axis)
    if (group.fixed[axis])
      balance.fix(axis, kept[axis]);
  const Point now = balance.velocity(), shift = bones.dt * (now - v_m);
  put(now, v, m);
  put(u_m + shift, u, m);
  for (auto t = group.begin; t < group.end; ++t)
  {
    const Tie& tie = ties_[t];
    const double r = tie.ratio;
    if (tie.surface < 0)
    {
      put(bones.velocity(tie.bone, tie.rest) + r * (now - bones.velocity(tie.bone, rest)), v, tie.node);
      put(bones.displacement(tie.bone, tie.rest) + r * (u_m + shift - bones.displacement(tie.bone, rest)), u, tie.node);
      continue;
    }
    const Point u_s = point_of(u, tie.node), v_s = point_of(v, tie.node);
    const Relative s = relative(tie.plane, tie, tie.rest + u_s), at_m = relative(tie.master_plane, tie, place_m);
    const double steepness = dot(s.gradient, s.gradient);
    if (!(steepness > 0))
      continue;
    const double speed =
        r * dot(at_m.gradient, now - at_m.surface_velocity) - dot(s.gradient, v_s - s.surface_velocity);
    const double apart = s.level + bones.dt * speed - r * (at_m.level + dot(at_m.gradient, shift)) - tie.offset;
    // An error of the level is removed gradually, as for other sliding nodes (physics/sliding.hpp).
    const double left = std::clamp(0.5 * apart, -physics::error_left, physics::error_left);
    put(v_s + (speed / steepness) * s.gradient, v, tie.node);
    put(u_s + ((bones.dt * speed - (apart - left)) / steepness) * s.gradient, u, tie.node);
  }
}

template class AttachedNodes<float>;
template class AttachedNodes<double>;

}  // namespace frontalis
