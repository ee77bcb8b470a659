#include "solver/stepping/restricted_nodes.hpp"

#include "frontalis/model/sample_field.hpp"
#include "frontalis/physics/element/node_motion.hpp"
#include "frontalis/physics/element/sliding_node.hpp"
#include "frontalis/physics/ramp.hpp"
#include "solver/cpu/prefetch.hpp"
#include "solver/stepping/attached_blocks.hpp"

#include <algorithm>
#include <cmath>
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

bool same(const RigidTransform& a, const RigidTransform& b)
{
  return a.rotation == b.rotation && a.translation == b.translation;
}

template <class Real>
void set(SlidingBlock<Real>& block, int lane, const Point& normal, double offset, const Point& reference, double speed)
{
  const double n[3] = { normal.x, normal.y, normal.z }, r[3] = { reference.x, reference.y, reference.z };
  for (int axis = 0; axis < 3; ++axis)
  {
    block.normal[axis][lane] = static_cast<Real>(n[axis]);
    block.reference[axis][lane] = static_cast<Real>(r[axis]);
  }
  block.offset[lane] = static_cast<Real>(offset);
  block.speed[lane] = static_cast<Real>(speed);
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
  // Replacing a plane that was kept for several steps jolts the tissue. If any surface has friction, no node keeps its
  // plane: friction also responds to the jolts of nodes without friction, and would dissipate several percent too much.
  const auto& surfaces = model.constraint_surfaces;
  const bool rough = std::any_of(surfaces.begin(), surfaces.end(), [](const auto& s) { return s.friction > 0; });
  if (!rough)
    make_blocks(sliding);
  for (std::size_t n = 0; rough && n < sliding.size(); ++n)
  {
    const SlidingNode& node = sliding[n];
    const auto& surface = surfaces[node.surface];
    gliding_.add({ node.node,
                   surface.bone,
                   surface.friction,
                   rest_point(model, node.node),
                   { &fields_[node.surface], node.distance } });
  }
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
    sliding_.push_back({ rest_point(model_, node.node), { &fields_[node.surface], node.distance }, bone, carried });
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
  list.add(Effect::rigid_nodes, "rigid nodes", still_);
  list.add(Effect::prescribed_displacement, "prescribed nodes", prescribed_);
  gliding_.list_arrays(list);
  list.add(Effect::sliding, "nodes that slide", sliding_);
  list.add_state(Effect::sliding, "tangent planes", contacts_.gliding);
  list.add_state(Effect::sliding, "tangent planes", contacts_.blocks);
  list.add_state(Effect::sliding, "tangent planes", contacts_.carried);
  list.add_state(Effect::sliding, "tangent planes", contacts_.carriers);
  list.add(Effect::sliding, "tangent planes", block_node_);
  list.add(Effect::sliding, "tangent planes", block_count_);
  list.add(Effect::sliding, "tangent planes", block_sliding_);
}

template <class Real>
void RestrictedNodes<Real>::reset()
{
  contacts_.gliding.assign(gliding_.size(), {});
  contacts_.blocks.assign(block_node_.size(), {});
  contacts_.carried.assign(carried_, {});
  for (Carrier& carrier : contacts_.carriers)
    carrier = { carrier.block, carrier.bone, {}, 0 };
  for (std::size_t block = 0; block < contacts_.blocks.size(); ++block)
    for (int lane = 0; lane < Block::width; ++lane)
      contacts_.blocks[block].slip_squared[lane] =
          block_sliding_[block][lane] < 0 ? std::numeric_limits<Real>::max() : Real(-1);
}

// Moves the tangent planes of nodes that slide on a bone with the bone. A plane that was found at one pose of the bone
// is valid at the others, because it is stored in the frame of the bone.
template <class Real>
void RestrictedNodes<Real>::carry(Carrier& carrier, const Real* const u[3], const ConstraintStep& step)
{
  const RigidTransform& now = step.bone[carrier.bone];
  const std::int64_t moves = same(now, step.bone_before[carrier.bone]) ? 0 : 1;
  if (moves + carrier.moves == 0 && same(now, carrier.pose))
    return;
  const physics::Pose pose = pose_of(now), before = pose_of(step.bone_before[carrier.bone]);
  Block& b = contacts_.blocks[carrier.block];
  for (int lane = 0; lane < Block::width; ++lane)
  {
    const std::int32_t index = block_sliding_[carrier.block][lane], n = block_node_[carrier.block] + lane;
    if (index < 0 || sliding_[index].bone != carrier.bone || b.slip_squared[lane] < 0)
      continue;
    const Sliding& s = sliding_[index];
    const Carried& plane = contacts_.carried[s.carried];
    const Point normal = pose.turned(plane.normal), shift{ pose.t[0], pose.t[1], pose.t[2] };
    const Point place = s.rest + Point{ u[0][n], u[1][n], u[2][n] };
    const Point reference = pose.outwards(plane.found_at) - s.rest;
    set(b, lane, normal, plane.height + dot(normal, shift - s.rest), reference,
        dot(normal, physics::surface_velocity(pose, before, 1 / step.dt, pose.inwards(place))));
  }
  carrier.pose = now;
  carrier.moves = moves;
}

// Finds new planes for the nodes of blocks that have left the range of theirs, sixteen at a time.
template <class Real>
void RestrictedNodes<Real>::renew(const WaitingBlock* waiting, std::int32_t count, Real* const u[3], Real* const v[3],
                                  const ConstraintStep& step)
{
  Renewal renewals[PlaneBatch::width];
  int filled = 0;
  for (std::int32_t i = 0; i < count; ++i)
    for (std::uint32_t lanes = waiting[i].lanes; lanes != 0; lanes &= lanes - 1)
    {
      const int lane = __builtin_ctz(lanes);
      const std::int32_t block = waiting[i].block, index = block_sliding_[block][lane];
      // A node that does not slide waits if its displacement is infinite.
      if (index < 0)
        continue;
      prefetch(&sliding_[index]);
      renewals[filled++] = { block, lane, index, {} };
      if (filled == PlaneBatch::width)
        renew_batch(renewals, std::exchange(filled, 0), u, v, step);
    }
  renew_batch(renewals, filled, u, v, step);
}

// Each loop needs data that the loop before it has begun to fetch.
template <class Real>
void RestrictedNodes<Real>::renew_batch(Renewal* renewals, int count, Real* const u[3], Real* const v[3],
                                        const ConstraintStep& step)
{
  constexpr int width = PlaneBatch::width;
  PlaneBatch batch{};
  std::int32_t cell[width][3];
  int filled = 0;
  for (int l = 0; l < count; ++l)
  {
    Renewal renewal = renewals[l];
    const Sliding& s = sliding_[renewal.index];
    const std::int32_t n = block_node_[renewal.block] + renewal.lane;
    const Point at = s.rest + Point{ u[0][n], u[1][n], u[2][n] };
    renewal.place = s.bone < 0 ? at : pose_of(step.bone[s.bone]).inwards(at);
    const physics::DistanceField& field = *s.level.field;
    if (kernels_.planes == nullptr || field.radius > 0)
    {
      if (physics::LevelPlane<double> plane{}; s.level.plane_at(renewal.place, plane))
        take(renewal, plane, u, v, step);
      continue;
    }
    auto point = physics::field_point(field, renewal.place);
    const double inverse_spacing = 1 / field.spacing;
    const Point place = physics::enter_cell(inverse_spacing, point.offset, point.cell);
    std::copy(point.cell, point.cell + 3, cell[filled]);
    batch.place[0][filled] = static_cast<float>(place.x);
    batch.place[1][filled] = static_cast<float>(place.y);
    batch.place[2][filled] = static_cast<float>(place.z);
    batch.inverse_spacing[filled] = static_cast<float>(inverse_spacing);
    batch.level[filled] = static_cast<float>(s.level.level);
    renewals[filled++] = renewal;
  }
  bool sampled[width] = {};
  const float* some = nullptr;
  for (int l = 0; l < filled; ++l)
  {
    batch.first[l] = sliding_[renewals[l].index].level.field->around(cell[l]);
    prefetch_samples(batch.first[l]);
    sampled[l] = batch.first[l] != nullptr;
    some = sampled[l] ? batch.first[l] : some;
  }
  if (some == nullptr)
    return;
  // Lanes without samples take those of another, and the result is not used.
  for (int l = 0; l < width; ++l)
    batch.first[l] = sampled[l] ? batch.first[l] : some;
  kernels_.planes(batch);
  for (int l = 0; l < filled; ++l)
    if (sampled[l] && batch.slope[l] > static_cast<float>(physics::least_gradient))
      take(renewals[l],
           { { double(batch.normal[0][l]), double(batch.normal[1][l]), double(batch.normal[2][l]) },
             double(batch.distance[l]),
             double(batch.slip[l]) },
           u, v, step);
}

// Gives a node a new plane, and turns its velocity with the plane.
template <class Real>
void RestrictedNodes<Real>::take(const Renewal& renewal, const physics::LevelPlane<double>& plane, Real* const u[3],
                                 Real* const v[3], const ConstraintStep& step)
{
  const int lane = renewal.lane;
  const std::int32_t n = block_node_[renewal.block] + lane;
  const Sliding& s = sliding_[renewal.index];
  Block& b = contacts_.blocks[renewal.block];
  const physics::Pose pose = s.bone < 0 ? physics::Pose() : pose_of(step.bone[s.bone]);
  Point surface_velocity{ 0, 0, 0 };
  if (s.bone >= 0)
  {
    const physics::Pose before = pose_of(step.bone_before[s.bone]);
    surface_velocity = physics::surface_velocity(pose, before, 1 / step.dt, renewal.place);
    contacts_.carried[s.carried] = { plane.normal, dot(plane.normal, renewal.place) - plane.distance, renewal.place };
  }
  const Point normal = pose.turned(plane.normal), moved{ u[0][n], u[1][n], u[2][n] };
  const Point velocity =
      surface_velocity + physics::turned_with_normal({ b.normal[0][lane], b.normal[1][lane], b.normal[2][lane] },
                                                     normal, Point{ v[0][n], v[1][n], v[2][n] } - surface_velocity);
  v[0][n] = static_cast<Real>(velocity.x);
  v[1][n] = static_cast<Real>(velocity.y);
  v[2][n] = static_cast<Real>(velocity.z);
  set(b, lane, normal, dot(normal, moved) - plane.distance, moved, dot(normal, surface_velocity));
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
    const std::int32_t first_block = block_of(first), end_block = block_of(last);
    for (Carrier& carrier : contacts_.carriers)
      if (carrier.block >= first_block && carrier.block < end_block)
        carry(carrier, u, step);
    std::vector<WaitingBlock> waiting(static_cast<std::size_t>(end_block - first_block));
    SlideArguments<Real> nodes{ contacts_.blocks.data(), block_node_.data(),   block_count_.data(),
                                { u[0], u[1], u[2] },    { v[0], v[1], v[2] }, waiting.data() };
    const std::int32_t count = kernels_.slide(nodes, first_block, end_block);
    renew(waiting.data(), count, u, v, step);
    nodes.waiting = nullptr;
    for (std::int32_t i = 0; i < count; ++i)
      kernels_.slide(nodes, waiting[i].block, waiting[i].block + 1);
    gliding_.apply(first, last, u, v, step, contacts_.gliding);
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
