#include "solver/stepping/restricted_nodes.hpp"

#include "frontalis/model/sample_field.hpp"
#include "frontalis/physics/element/node_motion.hpp"
#include "frontalis/physics/element/sliding_node.hpp"
#include "frontalis/physics/ramp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace frontalis
{
namespace
{

using Point = physics::Vec3<double>;

template <class Entry>
auto range(std::vector<Entry>& entries, std::int32_t first, std::int32_t last)
{
  const auto before = [](const Entry& entry, std::int32_t node) { return entry.node < node; };
  return std::make_pair(std::lower_bound(entries.begin(), entries.end(), first, before),
                        std::lower_bound(entries.begin(), entries.end(), last, before));
}

template <class Entry>
void sort_by_node(std::vector<Entry>& entries)
{
  std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.node < b.node; });
}

Point rest_point(const Model& model, std::int32_t node)
{
  const auto p = rest_position(model, node);
  return { p[0], p[1], p[2] };
}

}  // namespace

template <class Real>
RestrictedNodes<Real>::RestrictedNodes(const Model& model, SlideKernel<Real> kernel)
    : model_(model), kernel_(kernel), rigid_(model.rigid), prescribed_(model.prescribed)
{
  for (const auto& surface : model.constraint_surfaces)
    fields_.push_back(view(surface.field));
  sort_by_node(rigid_);
  sort_by_node(prescribed_);
  auto sliding = model.sliding;
  sort_by_node(sliding);
  // Replacing a plane that was kept for several steps jolts the tissue. If any surface has friction, no node keeps its
  // plane: friction also responds to the jolts of nodes without friction, and would dissipate several percent too much.
  const auto& surfaces = model.constraint_surfaces;
  const bool rough = std::any_of(surfaces.begin(), surfaces.end(), [](const auto& s) { return s.friction > 0; });
  const auto plain =
      std::stable_partition(sliding.begin(), sliding.end(),
                            [&](const SlidingNode& node) { return rough || surfaces[node.surface].bone >= 0; });
  for (auto node = sliding.begin(); node != plain; ++node)
  {
    const auto& surface = model.constraint_surfaces[node->surface];
    gliding_.add({ node->node,
                   surface.bone,
                   surface.friction,
                   rest_point(model, node->node),
                   { &fields_[node->surface], node->distance } });
  }
  make_blocks({ plain, sliding.end() });
  reset();
}

// Collects sliding nodes in blocks. A block starts at the first sliding node that is in no block yet, or earlier if the
// block would otherwise extend beyond the node plane.
template <class Real>
void RestrictedNodes<Real>::make_blocks(const std::vector<SlidingNode>& nodes)
{
  const auto end_of_plane = [&](std::int32_t node)
  {
    const auto above = [](const std::array<std::int32_t, 3>& a, std::int32_t k) { return a[2] <= k; };
    return static_cast<std::int32_t>(
        std::lower_bound(model_.nodes.begin() + node, model_.nodes.end(), model_.nodes[node][2], above) -
        model_.nodes.begin());
  };
  std::int32_t covered = 0;
  for (const auto& node : nodes)
  {
    if (node.node >= covered)
    {
      const std::int32_t end = end_of_plane(node.node);
      std::int32_t first = std::min(node.node, std::max(0, end - Block::width));
      while (model_.nodes[first][2] != model_.nodes[node.node][2])
        ++first;
      block_node_.push_back(first);
      block_count_.push_back(std::min(end - first, std::int32_t{ Block::width }));
      block_sliding_.emplace_back().fill(-1);
      covered = first + block_count_.back();
    }
    block_sliding_.back()[node.node - block_node_.back()] = static_cast<std::int32_t>(sliding_.size());
    sliding_.push_back({ rest_point(model_, node.node), { &fields_[node.surface], node.distance } });
  }
}

template <class Real>
void RestrictedNodes<Real>::run(EffectSet running)
{
  slides_ = running.has(Effect::sliding);
  rubs_ = running.has(Effect::friction);
  gliding_.rub(rubs_);
  if (!slides_)
    reset();
  if (!rubs_)
    for (auto& state : contacts_.gliding)
      state.pressing = 0;
}

template <class Real>
void RestrictedNodes<Real>::list_arrays(ArrayList& list)
{
  list.add(Effect::rigid_nodes, "rigid nodes", rigid_);
  list.add(Effect::prescribed_displacement, "prescribed nodes", prescribed_);
  gliding_.list_arrays(list);
  list.add(Effect::sliding, "nodes that slide", sliding_);
  list.add_state(Effect::sliding, "tangent planes", contacts_.gliding);
  list.add_state(Effect::sliding, "tangent planes", contacts_.blocks);
  list.add(Effect::sliding, "tangent planes", block_node_);
  list.add(Effect::sliding, "tangent planes", block_count_);
  list.add(Effect::sliding, "tangent planes", block_sliding_);
}

template <class Real>
void RestrictedNodes<Real>::reset()
{
  contacts_.gliding.assign(gliding_.size(), {});
  contacts_.blocks.assign(block_node_.size(), {});
  for (std::size_t block = 0; block < contacts_.blocks.size(); ++block)
    for (int lane = 0; lane < Block::width; ++lane)
      contacts_.blocks[block].slip_squared[lane] =
          block_sliding_[block][lane] < 0 ? std::numeric_limits<Real>::max() : Real(-1);
}

template <class Real>
void RestrictedNodes<Real>::renew(void* self, std::int32_t block, int lane, const Real u[3], Real v[3])
{
  auto& nodes = *static_cast<RestrictedNodes*>(self);
  const auto index = nodes.block_sliding_[block][lane];
  // the kernel calls this also for a node that does not slide, if its displacement is NaN
  if (index < 0)
    return;
  const Sliding& s = nodes.sliding_[index];
  Block& b = nodes.contacts_.blocks[block];
  const Point moved{ u[0], u[1], u[2] };
  physics::LevelPlane<double> plane{};
  if (!s.level.plane_at(s.rest + moved, plane))
    return;
  const Point velocity = physics::turned_with_normal({ b.normal[0][lane], b.normal[1][lane], b.normal[2][lane] },
                                                     plane.normal, { v[0], v[1], v[2] });
  const double normal[3] = { plane.normal.x, plane.normal.y, plane.normal.z };
  const double turned[3] = { velocity.x, velocity.y, velocity.z };
  for (int axis = 0; axis < 3; ++axis)
  {
    v[axis] = static_cast<Real>(turned[axis]);
    b.normal[axis][lane] = static_cast<Real>(normal[axis]);
    b.reference[axis][lane] = u[axis];
  }
  b.offset[lane] = static_cast<Real>(dot(plane.normal, moved) - plane.distance);
  b.slip_squared[lane] = static_cast<Real>(plane.slip * plane.slip);
}

template <class Real>
void RestrictedNodes<Real>::constrain(const NodeShare& share, Real* const u[3], Real* const v[3],
                                      const Real* const before[3], const ConstraintStep& step)
{
  const std::int32_t first = share.first_node, last = share.end_node;
  const auto block_of = [&](std::int32_t node)
  {
    return static_cast<std::int32_t>(std::lower_bound(block_node_.begin(), block_node_.end(), node) -
                                     block_node_.begin());
  };
  if (slides_)
  {
    kernel_({ contacts_.blocks.data(),
              block_node_.data(),
              block_count_.data(),
              { u[0], u[1], u[2] },
              { v[0], v[1], v[2] },
              renew,
              this },
            block_of(first), block_of(last));
    gliding_.apply(first, last, u, v, step, contacts_.gliding);
  }

  if (!prescribed_.empty())
    follow_paths(first, last, u, v, before, step);
  if (!rigid_.empty())
    follow_bones(first, last, u, v, before, step);
}

template <class Real>
void RestrictedNodes<Real>::follow_paths(std::int32_t first, std::int32_t last, Real* const u[3], Real* const v[3],
                                         const Real* const before[3], const ConstraintStep& step)
{
  const auto nodes = range(prescribed_, first, last);
  for (auto p = nodes.first; p != nodes.second; ++p)
  {
    const Load& load = model_.loads[p->load];
    const double now = physics::ramped(step.time, load.ramp);
    for (int axis = 0; axis < 3; ++axis)
      if (load.fixed[axis])
        physics::move_to(load.value[axis] * now, before[axis][p->node], static_cast<Real>(step.dt), u[axis][p->node],
                         v[axis][p->node]);
  }
}

template <class Real>
void RestrictedNodes<Real>::follow_bones(std::int32_t first, std::int32_t last, Real* const u[3], Real* const v[3],
                                         const Real* const before[3], const ConstraintStep& step)
{
  const auto nodes = range(rigid_, first, last);
  for (auto r = nodes.first; r != nodes.second; ++r)
  {
    if (r->bone < 0)
    {
      for (int axis = 0; axis < 3; ++axis)
        u[axis][r->node] = v[axis][r->node] = 0;
      continue;
    }
    const Point p = rest_point(model_, r->node), moved = pose_of(step.bone[r->bone]).outwards(p) - p;
    const double to[3] = { moved.x, moved.y, moved.z };
    for (int axis = 0; axis < 3; ++axis)
      physics::move_to(to[axis], before[axis][r->node], static_cast<Real>(step.dt), u[axis][r->node], v[axis][r->node]);
  }
}

template class RestrictedNodes<float>;
template class RestrictedNodes<double>;

}  // namespace frontalis
