#include "solver/stepping/attached_blocks.hpp"

#include "frontalis/model/sample_field.hpp"
#include "frontalis/physics/sliding.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace frontalis
{

physics::Vec3<double> rest_point(const Model& model, std::int32_t node)
{
  const auto p = rest_position(model, static_cast<std::size_t>(node));
  return { p[0], p[1], p[2] };
}

double level_offset(const Model& model, const AttachedNode& node)
{
  const SampledField& field = model.constraint_surfaces[node.surface].field;
  const double offset = level_at(field, rest_position(model, static_cast<std::size_t>(node.node))) -
                        node.ratio * level_at(field, rest_position(model, static_cast<std::size_t>(node.master)));
  return std::isfinite(offset) ? offset : 0;
}

template <class Real>
AttachedBlocks<Real>::AttachedBlocks(const Model& model, const std::vector<double>& mass, AttachKernel<Real> kernel)
    : model_(model), mass_(mass), kernel_(kernel)
{
  for (const ConstraintSurface& surface : model.constraint_surfaces)
    fields_.push_back(view(surface.field));
}

template <class Real>
bool AttachedBlocks<Real>::add_group(const AttachedNode* begin, const AttachedNode* end)
{
  Group group{ begin->master, -1, {}, {} };
  for (const AttachedNode* node = begin; node != end; ++node)
  {
    const bool slides = node->surface >= 0;
    const std::int32_t bone = slides ? model_.constraint_surfaces[node->surface].bone : node->bone;
    if (bone >= 0 || (slides && group.surface >= 0 && node->surface != group.surface))
      return false;
    group.surface = std::max(group.surface, node->surface);
    (slides ? group.levels : group.held).push_back(*node);
  }
  groups_.push_back(std::move(group));
  return true;
}

template <class Real>
void AttachedBlocks<Real>::finish()
{
  // Groups arrive in the order of their masters. Within each series of neighbouring masters they are sorted by kind and
  // size, so that few lanes of rows are unused while the nodes of a block stay close to each other in memory.
  constexpr std::size_t neighbours = 128 * attach_width;
  const auto key = [](const Group& group)
  {
    return std::make_tuple(group.levels.empty(), group.held.empty(), group.levels.size(), group.held.size(),
                           group.master);
  };
  for (std::size_t begin = 0, end = 0; begin < groups_.size(); begin = end)
  {
    end = std::min(begin + neighbours, groups_.size());
    std::sort(groups_.data() + begin, groups_.data() + end,
              [&](const Group& a, const Group& b) { return key(a) < key(b); });
  }
  rows_before_ = { 0 };
  for (std::size_t begin = 0, end = 0; begin < groups_.size(); begin = end)
  {
    const auto joins = [&first = groups_[begin]](const Group& group)
    { return group.levels.empty() == first.levels.empty() && group.held.empty() == first.held.empty(); };
    while (end < groups_.size() && end < begin + attach_width && joins(groups_[end]))
      ++end;
    add_block(groups_.data() + begin, groups_.data() + end);
    rows_before_.push_back(masters_.size() + held_.size() + levels_.size());
  }
  groups_ = {};
  masses_changed();
  reset();
}

template <class Real>
void AttachedBlocks<Real>::add_block(const Group* begin, const Group* end)
{
  std::size_t held_rows = 0, level_rows = 0;
  for (const Group* group = begin; group != end; ++group)
  {
    held_rows = std::max(held_rows, group->held.size());
    level_rows = std::max(level_rows, group->levels.size());
  }
  MasterBlock<Real>& block = masters_.emplace_back();
  block.held_begin = static_cast<std::int32_t>(held_.size());
  block.level_begin = static_cast<std::int32_t>(levels_.size());
  held_.resize(held_.size() + held_rows);
  levels_.resize(levels_.size() + level_rows);
  block.held_end = static_cast<std::int32_t>(held_.size());
  block.level_end = static_cast<std::int32_t>(levels_.size());
  for (int lane = 0; lane < attach_width; ++lane)
  {
    const bool copy = lane >= end - begin;
    const Group& group = copy ? *begin : begin[lane];
    const auto node_of = [](const std::vector<AttachedNode>& nodes, std::size_t row) -> const AttachedNode&
    { return nodes[row < nodes.size() ? row : 0]; };
    for (std::size_t r = 0; r < held_rows; ++r)
    {
      HeldRow<Real>& row = held_[block.held_begin + r];
      const AttachedNode& node = node_of(group.held, r);
      row.node[lane] = node.node;
      row.ratio[lane] = static_cast<Real>(node.ratio);
      row.weight[lane] = r < group.held.size() ? 1 : 0;  // masses_changed() replaces the 1
    }
    for (std::size_t r = 0; r < level_rows; ++r)
    {
      LevelRow<Real>& row = levels_[block.level_begin + r];
      const AttachedNode& node = node_of(group.levels, r);
      row.node[lane] = node.node;
      row.ratio[lane] = static_cast<Real>(node.ratio);
      row.weight[lane] = r < group.levels.size() ? 1 : 0;
      row.offset[lane] = static_cast<Real>(level_offset(model_, node));
      row.planes.surface[lane] = node.surface;
    }
    block.node[lane] = group.master;
    block.planes.surface[lane] = group.surface;
  }
}

template <class Real>
void AttachedBlocks<Real>::masses_changed()
{
  for (auto& block : masters_)
    for (int lane = 0; lane < attach_width; ++lane)
    {
      double held_mass = 0;
      for (auto r = block.held_begin; r < block.held_end; ++r)
        if (HeldRow<Real>& row = held_[r]; row.weight[lane] != 0)
        {
          row.weight[lane] = static_cast<Real>(mass_[row.node[lane]] * row.ratio[lane]);
          held_mass += double(row.weight[lane]) * double(row.ratio[lane]);
        }
      for (auto r = block.level_begin; r < block.level_end; ++r)
        if (LevelRow<Real>& row = levels_[r]; row.weight[lane] != 0)
          row.weight[lane] = static_cast<Real>(mass_[row.node[lane]] * row.ratio[lane]);
      block.held_mass[lane] = static_cast<Real>(held_mass);
      block.mass[lane] = static_cast<Real>(mass_[block.node[lane]] + held_mass);
    }
}

template <class Real>
void AttachedBlocks<Real>::reset()
{
  const auto forget = [](Planes& planes)
  {
    Planes none{};
    std::copy(planes.surface, planes.surface + attach_width, none.surface);
    std::fill(none.slip_squared, none.slip_squared + attach_width, Real(-1));
    planes = none;
  };
  for (auto& row : levels_)
    forget(row.planes);
  for (auto& block : masters_)
    forget(block.planes);
}

template <class Real>
void AttachedBlocks<Real>::list_arrays(ArrayList& list)
{
  list.add_state(Effect::attachment, "masters of attached nodes", masters_);
  list.add(Effect::attachment, "attached nodes", held_);
  list.add_state(Effect::attachment, "attached nodes", levels_);
}

// First block of a thread. Each thread gets about the same number of rows.
template <class Real>
std::int32_t AttachedBlocks<Real>::first_block(int thread, int threads) const
{
  const std::size_t rows = rows_before_.back() * static_cast<std::size_t>(thread) / static_cast<std::size_t>(threads);
  return static_cast<std::int32_t>(std::lower_bound(rows_before_.begin(), rows_before_.end(), rows) -
                                   rows_before_.begin());
}

template <class Real>
void AttachedBlocks<Real>::constrain(const NodeShare& share, Real* const u[3], Real* const v[3], double dt)
{
  kernel_({ masters_.data(),
            held_.data(),
            levels_.data(),
            { u[0], u[1], u[2] },
            { v[0], v[1], v[2] },
            static_cast<Real>(dt),
            static_cast<Real>(physics::error_left),
            renew,
            this },
          first_block(share.thread, share.threads), first_block(share.thread + 1, share.threads));
}

// Linearises the level of a lane's node at the present displacement. Where the field ends or its gradient is too short,
// the lane keeps its previous plane.
template <class Real>
void AttachedBlocks<Real>::renew(void* self, Planes& planes, int lane, std::int32_t node, const Real u[3])
{
  const auto& blocks = *static_cast<const AttachedBlocks*>(self);
  const physics::DistanceField& field = blocks.fields_[planes.surface[lane]];
  const physics::Vec3<double> moved{ double(u[0]), double(u[1]), double(u[2]) };
  physics::FieldValue<double> value{};
  physics::LevelPlane<double> level{};
  if (!sample(field, field_point(field, rest_point(blocks.model_, node) + moved), value) ||
      !level_plane(value, 0.0, level))
    return;
  const double gradient[3] = { value.gradient.x, value.gradient.y, value.gradient.z };
  for (int axis = 0; axis < 3; ++axis)
  {
    planes.gradient[axis][lane] = static_cast<Real>(gradient[axis]);
    planes.reference[axis][lane] = u[axis];
  }
  planes.level[lane] = static_cast<Real>(value.value - dot(value.gradient, moved));
  planes.flat[lane] = static_cast<Real>(1 / dot(value.gradient, value.gradient));
  planes.slip_squared[lane] = static_cast<Real>(level.slip * level.slip);
}

template class AttachedBlocks<float>;
template class AttachedBlocks<double>;

}  // namespace frontalis
