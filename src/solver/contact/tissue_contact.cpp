#include "solver/contact/tissue_contact.hpp"

#include "frontalis/physics/sliding.hpp"
#include "solver/contact/body_motion.hpp"
#include "solver/contact/contact_stiffness.hpp"
#include "solver/cpu/prefetch.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace frontalis
{
namespace
{

using Vector = physics::Vec3<double>;

// A vertex may be behind a triangle without touching it, beyond its rim or because the two do not face each other. The
// pair is checked again when the vertex has moved by this multiple of the shortest voxel edge.
constexpr double patience = 0.02;

// The range of blocks that a thread processes.
std::pair<std::int32_t, std::int32_t> part_of(std::size_t blocks, const NodeShare& share)
{
  return { static_cast<std::int32_t>(blocks * share.thread / share.threads),
           static_cast<std::int32_t>(blocks * (share.thread + 1) / share.threads) };
}

}  // namespace

template <class Real>
TissueContact<Real>::TissueContact(const Model& model, const Discretisation& discretisation,
                                   const TouchKernels<Real>& kernels)
    : model_(model),
      kernels_(kernels),
      surface_(model),
      reach_(touch_search::reach * surface_.edge),
      nodes_(model, surface_.binding(), BoundNodeWay::Of::points)
{
  if (surface_.vertices.empty())
    return;
  const auto& stiffness = *discretisation.find_added<ContactStiffness>();
  plane_points_.assign(static_cast<std::size_t>(model.size[2]) + 2, 0);
  std::vector<std::vector<double>> areas;
  for (const SelfContact& contact : model.self_contacts)
  {
    areas.push_back(vertex_areas(contact.surface));
    rubs_ = rubs_ || contact.friction > 0;
  }
  for (const auto& vertex : surface_.vertices)
  {
    ++plane_points_[model.voxels[vertex.voxel][2] + 1];
    rest_.push_back(vertex.rest);
    const double whole = stiffness.of_self(vertex.contact, vertex.source_in_contact);
    per_area_.push_back(static_cast<float>(whole / std::max(areas[vertex.contact][vertex.source_in_contact], 1e-30)));
    stiffness_.push_back(static_cast<float>(0.5 * whole * double(vertex.area_share)));
  }
  std::partial_sum(plane_points_.begin(), plane_points_.end(), plane_points_.begin());
  make_vertex_blocks();
  make_tree();
  overlap_.assign(surface_.vertices.size(), 0);
  reset();
  find_overlap_at_rest();
}

template <class Real>
void TissueContact<Real>::make_vertex_blocks()
{
  const std::size_t count = surface_.vertices.size();
  for (const auto& vertex : surface_.vertices)
    for (const auto node : model_.voxel_nodes[vertex.voxel])
      bound_nodes_.push_back(node);
  std::sort(bound_nodes_.begin(), bound_nodes_.end());
  bound_nodes_.erase(std::unique(bound_nodes_.begin(), bound_nodes_.end()), bound_nodes_.end());
  node_forces_.assign(4 * bound_nodes_.size(), 0);
  vertex_blocks_.resize((count + touch_width - 1) / touch_width);
  for (std::size_t v = 0; v < stride(); ++v)
  {
    const std::size_t lane = v % touch_width;
    const auto& vertex = surface_.vertices[v < count ? v : v - lane];
    VertexBlock<Real>& block = vertex_blocks_[v / touch_width];
    for (std::size_t two = 0; two < 4; ++two)
    {
      const auto node = model_.voxel_nodes[vertex.voxel][2 * two];
      block.node[two][lane] = node;
      block.bound[two][lane] = static_cast<std::int32_t>(
          std::lower_bound(bound_nodes_.begin(), bound_nodes_.end(), node) - bound_nodes_.begin());
    }
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      block.coordinates[axis][lane] = Real(vertex.coordinates[axis]);
      block.inverse_spacing[axis] = static_cast<Real>(1 / model_.spacing[axis]);
    }
    for (std::size_t k = 0; k < 2; ++k)
    {
      block.tangent[k][0][lane] = static_cast<Real>(vertex.tangent[k].x);
      block.tangent[k][1][lane] = static_cast<Real>(vertex.tangent[k].y);
      block.tangent[k][2][lane] = static_cast<Real>(vertex.tangent[k].z);
    }
    block.plane[lane] = v < count ? model_.voxels[vertex.voxel][2] : -2;
  }
}

template <class Real>
MovedVertices<Real> TissueContact<Real>::moved_in(std::vector<Real>& components) const
{
  const auto at = [&](std::size_t component) { return components.data() + component * stride(); };
  return { at(6), rubs_ ? at(6 + Moved::stride) : nullptr, at(0) };
}

template <class Real>
void TissueContact<Real>::run(EffectSet running)
{
  runs_ = running.has(Effect::self_contact);
  if (!runs_)
    reset();
}

template <class Real>
void TissueContact<Real>::reset()
{
  const std::size_t count = surface_.vertices.size(), planes = static_cast<std::size_t>(model_.size[2]);
  if (count == 0)
    return;
  // The pairs of a vertex must be in one block, so that a block may have unused lanes.
  const std::size_t blocks = (most_pairs * count) / (touch_width - 1) + 1;
  moved_.assign((6 + Moved::stride + (rubs_ ? 4 : 0)) * stride(), 0);
  live_.assign(vertex_blocks_.size(), 1);
  pair_vertices_.assign(blocks, {});
  pairs_.assign(blocks, {});
  forces_.assign(blocks, {});
  due_.assign(blocks, 0);
  touches_.assign(blocks, 0);
  found_.assign(count, {});
  searched_.assign(3 * count, 0);
  clock_.assign(1, {});
  node_way_.assign(planes + 1, 0);
  lost_.assign(planes, 0);
  opened_.assign(1, 0);
  tree_.reset();
}

template <class Real>
void TissueContact<Real>::list_arrays(ArrayList& list)
{
  const Effect effect = Effect::self_contact;
  surface_.list_arrays(list, effect);
  nodes_.list_arrays(list, effect);
  list.add(effect, "vertices", rest_);
  list.add(effect, "vertices", stiffness_);
  list.add(effect, "vertices", per_area_);
  list.add(effect, "vertices", overlap_);
  list.add(effect, "vertices", vertex_blocks_);
  list.add(effect, "vertices", plane_points_);
  list.add(effect, "bound nodes", bound_nodes_);
  list.add(effect, "forces", forces_);
  list.add(effect, "forces", node_forces_);
  for (const auto& summed : summed_)
    list.add(effect, "forces", summed);
  for (const auto& sums : sums_)
    list.add(effect, "forces", sums);
  if (surface_.vertices.empty())
    return;
  list.add_state(effect, "places", moved_);
  list.add_state(effect, "places", live_);
  list.add_state(effect, "pairs", pair_vertices_);
  list.add_state(effect, "pairs", pairs_);
  list.add_state(effect, "pairs", found_);
  list.add_state(effect, "places", searched_);
  list.add_state(effect, "distances", due_);
  list.add_state(effect, "forces", touches_);
  list.add_state(effect, "distances", clock_);
  list.add_state(effect, "distances", node_way_);
  list.add_state(effect, "sums", lost_);
  list.add_state(effect, "sums", opened_);
  tree_.list_arrays(list, effect);
}

template <class Real>
double TissueContact<Real>::way_now() const
{
  return clock_[0].way + 2 * *std::max_element(node_way_.begin(), node_way_.end());
}

template <class Real>
void TissueContact<Real>::prepare_step(const NodeShare& share, const Real* const u[3])
{
  if (share.thread == 0 && sums_.size() < static_cast<std::size_t>(share.threads))
  {
    sums_.resize(share.threads, std::vector<Real>(8 * stride(), 0));
    summed_.resize(share.threads, std::vector<std::uint8_t>(vertex_blocks_.size(), 0));
  }
  const Stage stage = clock_[0].stage;
  if (share.thread == 0 && stage == Stage::collect)
    collect_pairs();
  if (rests())
    return;
  const Moved moved = moved_in(moved_);
  const auto [begin, end] = part_of(vertex_blocks_.size(), share);
  const auto wanted = [&](std::int32_t b) { return stage != Stage::hold || live_[b] != 0; };
  for (auto b = begin; b < end;)
  {
    auto last = b;
    while (last < end && wanted(last))
      ++last;
    kernels_.place(vertex_blocks_.data(), moved, { u[0], u[1], u[2] }, b, last);
    b = last + 1;
  }
}

template <class Real>
void TissueContact<Real>::before_step(const NodeShare& share, const Real* const /*u*/[3], const ConstraintStep& step)
{
  const double way = way_now();
  const Stage stage = clock_[0].stage;
  if (share.thread == 0)
  {
    next_ = clock_[0];
    next_.way = way;
    next_.dt = step.dt;
    choose_stage(stage, way);
  }
  if (rests())
    return;
  const auto [first, last] = part_of(static_cast<std::size_t>(clock_[0].blocks), share);
  Arena in = arena(clock_[0].blocks);
  touch(in, way, step.dt, first, last);
  if (stage != Stage::search)
    return;
  const std::size_t count = surface_.vertices.size();
  for (std::size_t p = count * share.thread / share.threads; p < count * (share.thread + 1) / share.threads; ++p)
    found_[p] = search(p);
}

template <class Real>
void TissueContact<Real>::touch(Arena& arena, double way, double dt, std::int32_t first, std::int32_t last) const
{
  kernels_.touch({ arena.pair_vertices.data(), arena.pairs.data(), arena.forces.data(), arena.due.data(),
                   arena.touches.data(), arena.moved, way, static_cast<Real>(physics::friction_response(dt)),
                   static_cast<Real>(touch_search::deepest_held * surface_.edge),
                   static_cast<Real>(patience * surface_.edge), rubs_, go_on, &arena },
                 first, last);
}

// Adds up the forces on those vertices whose voxels have nodes in the share, in the order of the pairs.
template <class Real>
void TissueContact<Real>::add_up(const Arena& arena, const NodeShare& share, std::vector<Real>& sums,
                                 std::vector<std::uint8_t>& summed, std::vector<double>& lost) const
{
  const auto begin = static_cast<std::uint32_t>(plane_points_[std::max(share.first_plane - 1, 0)]);
  const auto count = static_cast<std::uint32_t>(plane_points_[share.end_plane]) - begin;
  // All numbers of a record are read before any is written, so that compilers can load them together.
  const auto add = [](Real sign, const Real* from, Real* to)
  {
    const Real record[4] = { to[0] + sign * from[0], to[1] + sign * from[1], to[2] + sign * from[2],
                             to[3] + sign * from[3] };
    std::copy(record, record + 4, to);
  };
  for (std::int32_t b = 0; b < arena.blocks; ++b)
  {
    if (arena.touches[b] == 0)
      continue;
    prefetch(arena.pair_vertices.data() + b + 1);
    prefetch(arena.forces.data() + b + 1);
    for (int lane = 0; lane < touch_width; ++lane)
    {
      const PairVertices& pairs = arena.pair_vertices[b];
      const PairForceBlock<Real>& force = arena.forces[b];
      if (rubs_)
        if (const auto plane = model_.voxels[surface_.vertices[pairs.vertex[0][lane]].voxel][2];
            plane >= share.first_plane && plane < share.end_plane)
          lost[plane] += double(force.lost[lane]);
      if ((arena.touches[b] >> lane & 1) == 0)
        continue;
      const std::int32_t record = kernels_.record[lane];
      const auto sum = [&](int i) -> Real*
      {
        const std::int32_t v = pairs.vertex[i][lane];
        if (static_cast<std::uint32_t>(v) - begin >= count)
          return nullptr;
        summed[v / touch_width] = 1;
        return sums.data() + 8 * std::ptrdiff_t{ v };
      };
      if (Real* const of_point = sum(0); of_point != nullptr)
      {
        const Real *const x = force.corner[0] + record, *const y = force.corner[1] + record,
                          *const z = force.corner[2] + record;
        const Real all[4] = { x[0] + y[0] + z[0], x[1] + y[1] + z[1], x[2] + y[2] + z[2], x[3] + y[3] + z[3] };
        add(-1, all, of_point);
      }
      for (int i = 0; i < 3; ++i)
      {
        Real* const of_corner = sum(i + 1);
        if (of_corner == nullptr)
          continue;
        add(1, force.corner[i] + record, of_corner);
        add(1, force.turn[i] + record, of_corner + 4);
      }
    }
  }
}

// Passes the sums of add_up() on to nodes: calls sink(node, force) for the nodes of the share on which they act.
template <class Real>
template <class Sink>
void TissueContact<Real>::push(const NodeShare& share, const Moved& moved, std::vector<Real>& sums,
                               std::vector<std::uint8_t>& summed, std::vector<Real>& node_forces,
                               const Sink& sink) const
{
  bool any = false;
  for (std::size_t b = 0; b < summed.size(); ++b)
    if (summed[b] != 0)
    {
      kernels_.spread(vertex_blocks_.data(), moved, sums.data(), node_forces.data(), static_cast<std::int32_t>(b),
                      share.first_plane, share.end_plane);
      summed[b] = 0;
      any = true;
    }
  if (!any)
    return;
  const auto begin =
      std::lower_bound(bound_nodes_.begin(), bound_nodes_.end(), share.first_node) - bound_nodes_.begin();
  const auto end = std::lower_bound(bound_nodes_.begin(), bound_nodes_.end(), share.end_node) - bound_nodes_.begin();
  for (auto n = begin; n < end; ++n)
  {
    Real* const f = node_forces.data() + 4 * n;
    if (f[0] == 0 && f[1] == 0 && f[2] == 0)
      continue;
    sink(bound_nodes_[n], { { double(f[0]), double(f[1]), double(f[2]) } });
    f[0] = f[1] = f[2] = 0;
  }
}

template <class Real>
void TissueContact<Real>::add_forces(const NodeShare& share, const ForceSink<Real>& sink)
{
  add_up(arena(next_.blocks), share, sums_[share.thread], summed_[share.thread], lost_);
  push(share, moved_in(moved_), sums_[share.thread], summed_[share.thread], node_forces_, sink);
  if (share.thread != 0)
    return;
  next_.earliest = std::numeric_limits<double>::max();
  for (std::int32_t b = 0; b < next_.blocks; ++b)
    next_.earliest = std::min(next_.earliest, due_[b]);
  clock_[0] = next_;
}

template <class Real>
void TissueContact<Real>::after_step(const NodeShare& share, const Real* const before[3], const Real* const after[3])
{
  for (auto k = share.first_plane; k < share.end_plane; ++k)
    node_way_[k] = nodes_.in_plane(k, before, after);
}

template <class Real>
void TissueContact<Real>::add_energies(const Real* const u[3], const std::vector<RigidTransform>& /*bones*/, bool open,
                                       std::vector<std::array<double, 3>>& forces, EnergyLedger& ledger)
{
  if (idle())
    return;
  double lost = std::accumulate(lost_.begin(), lost_.end(), 0.0), stored = 0;
  // The sums do not include the contribution of the latest step yet, because the next step adds it. It is added here.
  std::vector<Real> components = moved_;
  std::vector<PairVertices> pair_vertices = pair_vertices_;
  std::vector<PairBlock<Real>> pairs = pairs_;
  std::vector<PairForceBlock<Real>> pair_forces(pairs.size());
  std::vector<double> due(pairs.size(), 0), no_losses(lost_.size(), 0);
  std::vector<std::uint32_t> touches(pairs.size(), 0);
  const Moved moved = moved_in(components);
  kernels_.place(vertex_blocks_.data(), moved, { u[0], u[1], u[2] }, 0,
                 static_cast<std::int32_t>(vertex_blocks_.size()));
  Arena copy{ pair_vertices, pairs, pair_forces, due, touches, moved, this, clock_[0].blocks };
  touch(copy, 0, clock_[0].dt, 0, copy.blocks);
  for (std::int32_t b = 0; b < copy.blocks; ++b)
    for (int lane = 0; lane < touch_width; ++lane)
    {
      stored += double(pair_forces[b].stored[lane]);
      lost += double(pair_forces[b].lost[lane]);
    }
  if (!forces.empty())
  {
    const NodeShare all{ 0, 1, 0, model_.size[2] + 1, 0, static_cast<std::int32_t>(model_.nodes.size()) };
    std::vector<Real> sums(8 * stride(), 0), node_forces(node_forces_.size(), 0);
    std::vector<std::uint8_t> summed(vertex_blocks_.size(), 0);
    add_up(copy, all, sums, summed, no_losses);
    push(all, moved, sums, summed, node_forces,
         [&](std::int32_t node, const std::array<double, 3>& part) { add_vector(forces[node], vector_of(part)); });
  }
  if (open)
    opened_[0] = lost;
  ledger["contact_stored"] += stored;
  ledger["friction"] += lost - opened_[0];
}

template class TissueContact<float>;
template class TissueContact<double>;

}  // namespace frontalis
