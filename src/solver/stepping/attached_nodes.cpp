#include "solver/stepping/attached_nodes.hpp"

#include "frontalis/model/sample_field.hpp"
#include "solver/contact/bone_pose.hpp"

#include <algorithm>

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

std::vector<AttachedNode> nodes_by_master(const Model& model)
{
  std::vector<AttachedNode> nodes = model.attached;
  for (const Model::Joint& joint : model.joints)
    nodes.push_back({ joint.node, joint.master, 1, -1, -1, -1 });
  std::stable_sort(nodes.begin(), nodes.end(),
                   [](const AttachedNode& a, const AttachedNode& b) { return a.master < b.master; });
  return nodes;
}

std::vector<std::array<bool, 3>> prescribed_axes(const Model& model)
{
  std::vector<std::array<bool, 3>> fixed(model.nodes.size(), { { false, false, false } });
  for (const PrescribedNode& node : model.prescribed)
    for (std::size_t axis = 0; axis < 3; ++axis)
      fixed[node.node][axis] = fixed[node.node][axis] || model.loads[node.load].fixed[axis];
  return fixed;
}

template <class Real>
AttachedNodes<Real>::AttachedNodes(const Model& model, const std::vector<double>& mass, AttachKernel<Real> kernel)
    : model_(model), mass_(mass), blocks_(model, mass, kernel)
{
  for (const ConstraintSurface& surface : model.constraint_surfaces)
    fields_.push_back(view(surface.field));
  const std::vector<std::array<bool, 3>> fixed = prescribed_axes(model);
  const std::vector<AttachedNode> nodes = nodes_by_master(model);
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
void AttachedNodes<Real>::masses_changed()
{
  for (Tie& tie : ties_)
    tie.mass = mass_[tie.node];
  blocks_.masses_changed();
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
  Real* const of_u[3] = { u[0], u[1], u[2] };
  Real* const of_v[3] = { v[0], v[1], v[2] };
  for (auto group = begin; group != end; ++group)
    follow_on_bones(*group, of_u, of_v, bones);
}

// Linearises the level at `place` if `place` is outside the range of the present plane. Where the field ends or its
// gradient is too short, the present plane is kept.
template <class Real>
void AttachedNodes<Real>::renew(Plane& plane, std::int32_t surface, const Point& place) const
{
  const physics::DistanceField& field = fields_[surface];
  physics::FieldValue<double> value{};
  if (!plane.covers(place) && sample(field, field_point(field, place), value))
    physics::renew_level(value, place, plane);
}

/// A group in the form that move_attached_group() reads.
template <class Real>
struct AttachedNodes<Real>::MovedGroup
{
  using Motion = physics::PointMotion<double>;

  AttachedNodes& of;
  const Group& group;
  Real* const (&u)[3];
  Real* const (&v)[3];
  const Bones& bones;
  Point rest;  // of the master

  std::int32_t first() const { return group.begin; }
  std::int32_t last() const { return group.end; }
  std::int32_t stride() const { return 1; }
  void join(physics::Balance<double>& /*balance*/) const {}
  double mass() const { return of.mass_[group.master]; }
  bool fixed(int axis) const { return group.fixed[axis]; }
  const Tie& at(std::int32_t tie) const { return of.ties_[tie]; }
  bool held(std::int32_t tie) const { return at(tie).surface < 0; }
  double ratio(std::int32_t tie) const { return at(tie).ratio; }
  double mass(std::int32_t tie) const { return at(tie).mass; }
  double offset(std::int32_t tie) const { return at(tie).offset; }

  Motion motion_of(std::int32_t node) const { return { point_of(u, node), point_of(v, node) }; }
  void set_motion_of(std::int32_t node, const Motion& motion) const
  {
    put(motion.u, u, node);
    put(motion.v, v, node);
  }
  Motion motion() const { return motion_of(group.master); }
  Motion motion(std::int32_t tie) const { return motion_of(at(tie).node); }
  void set_motion(const Motion& motion) const { set_motion_of(group.master, motion); }
  void set_motion(std::int32_t tie, const Motion& motion) const { set_motion_of(at(tie).node, motion); }

  Motion bone_at(std::int32_t bone, const Point& p) const
  {
    return { bones.displacement(bone, p), bones.velocity(bone, p) };
  }
  void bone_at(std::int32_t tie, Motion& node, Motion& master) const
  {
    node = bone_at(at(tie).bone, at(tie).rest);
    master = bone_at(at(tie).bone, rest);
  }

  physics::MovingLevel<double> level(std::int32_t plane, const Tie& tie, const Point& place) const
  {
    const physics::Pose& pose = bones.now[bones.index(tie.bone)];
    const Point p = pose.inwards(place);
    Plane& kept = of.planes_[plane];
    of.renew(kept, tie.surface, p);
    return { pose.turned(kept.gradient), bones.velocity(tie.bone, p), kept.level_at(p) };
  }
  void levels(std::int32_t tie, const Point& moved, const Point& master_moved, physics::MovingLevel<double>& own,
              physics::MovingLevel<double>& masters) const
  {
    own = level(at(tie).plane, at(tie), at(tie).rest + moved);
    masters = level(at(tie).master_plane, at(tie), rest + master_moved);
  }
};

template <class Real>
void AttachedNodes<Real>::follow_on_bones(const Group& group, Real* const (&u)[3], Real* const (&v)[3],
                                          const Bones& bones)
{
  MovedGroup moved{ *this, group, u, v, bones, rest_point(model_, group.master) };
  physics::move_attached_group(moved, bones.dt);
}

template class AttachedNodes<float>;
template class AttachedNodes<double>;

}  // namespace frontalis
