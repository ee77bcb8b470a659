#include "solver/stepping/restricted_nodes.hpp"

#include "frontalis/model/sample_field.hpp"
#include "frontalis/physics/element/node_motion.hpp"
#include "frontalis/physics/element/sliding_node.hpp"
#include "frontalis/physics/ramp.hpp"
#include "solver/contact/bone_pose.hpp"
#include "solver/stepping/attached_blocks.hpp"

#include <algorithm>
#include <limits>
#include <utility>

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

}  // namespace

template <class Real>
RestrictedNodes<Real>::RestrictedNodes(const Model& model, const SlideKernels<Real>& kernels)
    : model_(model), kernels_(kernels), prescribed_(model.prescribed)
{
  for (const auto& surface : model.constraint_surfaces)
    fields_.push_back(view(surface.field));
  auto rigid = model.rigid;
  sort_by_node(rigid);
  sort_by_node(prescribed_);
  for (const RigidNode& node : rigid)
    if (node.bone >= 0)
      rigid_.push_back({ node.node, node.bone, rest_point(model, node.node) });
    else if (!still_.empty() && still_.back().node + still_.back().count == node.node)
      ++still_.back().count;
    else
      still_.push_back({ node.node, 1 });
  auto sliding = model.sliding;
  sort_by_node(sliding);
  make_blocks(sliding);
  // Replacing a plane that was kept for several steps jolts the tissue. If any surface has friction, the planes of all
  // nodes turn with their level sets: friction also responds to the jolts of nodes without friction, and would
  // dissipate several percent too much.
  const auto& surfaces = model.constraint_surfaces;
  if (std::any_of(surfaces.begin(), surfaces.end(), [](const auto& s) { return s.friction > 0; }))
    contacts_.rough.resize(block_node_.size());
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
    const std::int32_t bone = model_.constraint_surfaces[node.surface].bone;
    const auto block = static_cast<std::int32_t>(block_node_.size()) - 1;
    const auto same = [&](const Carrier& carrier) { return carrier.block == block && carrier.bone == bone; };
    auto& carriers = contacts_.carriers;
    if (bone >= 0 && std::none_of(carriers.begin(), carriers.end(), same))
      carriers.push_back({ block, bone, {}, 0 });
    const std::int32_t carried = bone < 0 ? -1 : carried_++;
    sliding_.push_back({ rest_point(model_, node.node),
                         { &fields_[node.surface], node.distance },
                         bone,
                         carried,
                         model_.constraint_surfaces[node.surface].friction });
  }
}

template <class Real>
void RestrictedNodes<Real>::run(EffectSet running)
{
  slides_ = running.has(Effect::sliding);
  const bool switched = rubs_ != running.has(Effect::friction);
  rubs_ = running.has(Effect::friction);
  if (!slides_)
    reset();
  // The reaction is followed while friction is off, too.
  for (auto& rough : contacts_.rough)
    if (switched)
      std::fill_n(rough.pressing, Block::width, Real(0));
}

template <class Real>
void RestrictedNodes<Real>::list_arrays(ArrayList& list)
{
  list.add(Effect::rigid_nodes, "rigid nodes", rigid_);
  list.add(Effect::rigid_nodes, "rigid nodes", still_);
  list.add(Effect::prescribed_displacement, "prescribed nodes", prescribed_);
  list.add(Effect::sliding, "nodes that slide", sliding_);
  list.add_state(Effect::sliding, "tangent planes", contacts_.blocks);
  list.add_state(Effect::friction, "planes with friction", contacts_.rough);
  list.add_state(Effect::sliding, "tangent planes", contacts_.carried);
  list.add_state(Effect::sliding, "tangent planes", contacts_.carriers);
  list.add(Effect::sliding, "tangent planes", block_node_);
  list.add(Effect::sliding, "tangent planes", block_count_);
  list.add(Effect::sliding, "tangent planes", block_sliding_);
}

template <class Real>
void RestrictedNodes<Real>::reset()
{
  contacts_.blocks.assign(block_node_.size(), {});
  contacts_.carried.assign(carried_, {});
  for (Carrier& carrier : contacts_.carriers)
    carrier = { carrier.block, carrier.bone, {}, 0 };
  for (std::size_t block = 0; block < contacts_.blocks.size(); ++block)
    for (int lane = 0; lane < Block::width; ++lane)
      contacts_.blocks[block].slip_squared[lane] =
          block_sliding_[block][lane] < 0 ? std::numeric_limits<Real>::max() : Real(-1);
  for (std::size_t block = 0; block < contacts_.rough.size(); ++block)
  {
    contacts_.rough[block] = {};
    for (int lane = 0; lane < Block::width; ++lane)
      if (const std::int32_t index = block_sliding_[block][lane]; index >= 0)
        contacts_.rough[block].coefficient[lane] = static_cast<Real>(sliding_[index].friction);
  }
}

template <class Real>
std::int32_t RestrictedNodes<Real>::block_of(std::int32_t node) const
{
  return static_cast<std::int32_t>(std::lower_bound(block_node_.begin(), block_node_.end(), node) -
                                   block_node_.begin());
}

template <class Real>
double RestrictedNodes<Real>::friction_loss(std::int32_t first, std::int32_t last, const std::vector<double>& mass,
                                            const Real* const before[3], const Real* const without[3],
                                            const Real* const after[3]) const
{
  const auto at = [](const Real* const v[3], std::int32_t n) { return Point{ v[0][n], v[1][n], v[2][n] }; };
  const auto of_lane = [](const Real(&v)[3][Block::width], int l) { return Point{ v[0][l], v[1][l], v[2][l] }; };
  double lost = 0;
  if (contacts_.rough.empty() || !slides_ || !rubs_)
    return lost;
  const std::int32_t end = block_of(last);
  for (std::int32_t block = block_of(first); block < end; ++block)
  {
    const RoughBlock<Real>& rough = contacts_.rough[block];
    for (std::int32_t lane = 0; lane < block_count_[block]; ++lane)
      if (const std::int32_t n = block_node_[block] + lane; rough.coefficient[lane] > 0)
        lost += mass[n] * physics::friction_work(of_lane(rough.outward, lane), of_lane(rough.surface_velocity, lane),
                                                 at(before, n), at(without, n), at(after, n));
  }
  return lost;
}

template <class Real>
void RestrictedNodes<Real>::constrain(const NodeShare& share, Real* const u[3], Real* const v[3],
                                      const Real* const before[3], const ConstraintStep& step)
{
  const std::int32_t first = share.first_node, last = share.end_node;
  if (slides_)
  {
    const std::int32_t first_block = block_of(first), end_block = block_of(last);
    for (Carrier& carrier : contacts_.carriers)
      if (carrier.block >= first_block && carrier.block < end_block)
        carry(carrier, u, step);
    std::vector<WaitingBlock> waiting(static_cast<std::size_t>(end_block - first_block));
    SlideArguments<Real> nodes{ contacts_.blocks.data(),    contacts_.rough.empty() ? nullptr : contacts_.rough.data(),
                                Real(rubs_ ? 1 : 0),        static_cast<Real>(physics::friction_response(step.dt)),
                                static_cast<Real>(step.dt), block_node_.data(),
                                block_count_.data(),        { u[0], u[1], u[2] },
                                { v[0], v[1], v[2] },       waiting.data() };
    const std::int32_t count = kernels_.slide(nodes, first_block, end_block);
    renew(waiting.data(), count, u, v, step);
    nodes.waiting = nullptr;
    for (std::int32_t i = 0; i < count; ++i)
      kernels_.slide(nodes, waiting[i].block, waiting[i].block + 1);
  }

  if (!prescribed_.empty())
    follow_paths(first, last, u, v, before, step);
  hold_still(first, last, u, v);
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
  const auto dt = static_cast<Real>(step.dt);
  physics::Pose pose;
  std::int32_t bone = -1;
  for (auto r = nodes.first; r != nodes.second; ++r)
  {
    if (r->bone != std::exchange(bone, r->bone))
      pose = pose_of(step.bone[bone]);
    const Point moved = pose.outwards(r->rest) - r->rest;
    const double to[3] = { moved.x, moved.y, moved.z };
    for (int axis = 0; axis < 3; ++axis)
      physics::move_to(to[axis], before[axis][r->node], dt, u[axis][r->node], v[axis][r->node]);
  }
}

// Holds the rigid nodes that no bone moves, run by run. A run may begin in the share of another thread.
template <class Real>
void RestrictedNodes<Real>::hold_still(std::int32_t first, std::int32_t last, Real* const u[3], Real* const v[3]) const
{
  const auto before = [](const StillRun& run, std::int32_t node) { return run.node + run.count <= node; };
  for (auto run = std::lower_bound(still_.begin(), still_.end(), first, before);
       run != still_.end() && run->node < last; ++run)
  {
    // Most runs are short, so that a call per field, as of memset(), would take longer than the stores.
    const std::int32_t begin = std::max(run->node, first), end = std::min(run->node + run->count, last);
    for (auto n = begin; n < end; ++n)
      for (int axis = 0; axis < 3; ++axis)
        u[axis][n] = v[axis][n] = 0;
  }
}

template class RestrictedNodes<float>;
template class RestrictedNodes<double>;

}  // namespace frontalis
