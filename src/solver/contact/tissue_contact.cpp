#include "solver/contact/tissue_contact.hpp"

#include "frontalis/physics/sliding.hpp"
#include "frontalis/physics/trilinear.hpp"
#include "solver/contact/body_motion.hpp"
#include "solver/contact/contact_stiffness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace frontalis
{
namespace
{

using Vector = physics::Vec3<double>;

// Lengths in shortest voxel edges: how far from a triangle a vertex finds it, and how deep behind it it is held.
constexpr double reach_share = 0.5;
constexpr double deepest_held = 1;
// After this way a vertex that is behind a triangle, but beyond its rim or not opposite to it, is looked at again.
constexpr double patience = 0.02;

// Share of the reach that vertices may move before the search is repeated.
constexpr double renewal_share = 0.8;

// The force on a vertex sets in over these ranges: of the cosine between its own inward normal and the normal of the
// surface that it touches, of that between this normal and the triangle's, and, beyond the rim of a surface, of the
// height of the rim's triangle.
constexpr double opposed = 0.25;
constexpr double least_upright = 0.2, upright = 0.4;
constexpr double rim_begin = 0.1, rim_end = 0.3;

double ramp(double x) { return std::clamp(x, 0.0, 1.0); }

}  // namespace

template <class Real>
TissueContact<Real>::TissueContact(const Model& model, const Discretisation& discretisation)
    : model_(model), surface_(model), reach_(reach_share * surface_.edge), nodes_(model, surface_.binding())
{
  if (surface_.vertices.empty())
    return;
  const auto& stiffness = *discretisation.find_added<ContactStiffness>();
  plane_points_.assign(static_cast<std::size_t>(model.size[2]) + 2, 0);
  std::vector<std::vector<double>> areas;
  for (const SelfContact& contact : model.self_contacts)
    areas.push_back(vertex_areas(contact.surface));
  for (const auto& vertex : surface_.vertices)
  {
    ++plane_points_[model.voxels[vertex.voxel][2] + 1];
    const double whole = stiffness.of_self(vertex.contact, vertex.source_in_contact);
    per_area_.push_back(static_cast<float>(whole / std::max(areas[vertex.contact][vertex.source_in_contact], 1e-30)));
    stiffness_.push_back(static_cast<float>(0.5 * whole * double(vertex.area_share)));
  }
  std::partial_sum(plane_points_.begin(), plane_points_.end(), plane_points_.begin());
  reset();
  find_overlap_at_rest();
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
  placed_.clear();
  for (const auto& vertex : surface_.vertices)
    placed_.push_back({ vertex.rest,
                        vertex.normal,
                        vertex.rest,
                        { { cross(vertex.tangent[1], vertex.normal), cross(vertex.normal, vertex.tangent[0]) } } });
  overlap_.resize(count, 0);
  live_.assign(count, 1);
  tracks_.assign(count * most_tracks, {});
  pairs_.assign(count * most_tracks, {});
  due_.assign(count, 0);
  chunks_.assign((count + chunk_size - 1) / chunk_size, {});
  clock_.assign(1, {});
  node_way_.assign(planes + 1, 0);
  lost_.assign(planes, 0);
  opened_.assign(1, 0);
  grid_.resize(surface_.triangles.size());
}

template <class Real>
void TissueContact<Real>::list_arrays(ArrayList& list)
{
  const Effect effect = Effect::self_contact;
  surface_.list_arrays(list, effect);
  nodes_.list_arrays(list, effect);
  list.add(effect, "vertices", stiffness_);
  list.add(effect, "vertices", per_area_);
  list.add(effect, "vertices", overlap_);
  list.add(effect, "vertices", plane_points_);
  list.add(effect, "forces", pairs_);
  for (const VertexForces& forces : forces_)
    list.add(effect, "forces", forces.force);
  if (surface_.vertices.empty())
    return;
  list.add_state(effect, "places", placed_);
  list.add_state(effect, "places", live_);
  list.add_state(effect, "tracks", tracks_);
  list.add_state(effect, "distances", due_);
  list.add_state(effect, "distances", chunks_);
  list.add_state(effect, "distances", clock_);
  list.add_state(effect, "distances", node_way_);
  list.add_state(effect, "sums", lost_);
  list.add_state(effect, "sums", opened_);
  grid_.list_arrays(list, effect);
}

template <class Real>
double TissueContact<Real>::way_now() const
{
  return clock_[0].way + 2 * nodes_.spread() * *std::max_element(node_way_.begin(), node_way_.end());
}

template <class Real>
void TissueContact<Real>::prepare_step(const NodeShare& share, const Real* const u[3])
{
  if (share.thread == 0 && forces_.size() < static_cast<std::size_t>(share.threads))
  {
    const std::vector<Vector> none(placed_.size(), { 0, 0, 0 });
    forces_.resize(share.threads, { none, none, std::vector<std::uint8_t>(placed_.size(), 0), {} });
  }
  if (rests())
    return;
  const bool all = clock_[0].stage != Stage::hold;
  const auto [begin, end] = chunks_of(share);
  for (std::size_t v = begin * chunk_size; v < std::min(end * chunk_size, placed_.size()); ++v)
    if (all || live_[v] != 0)
      surface_.place(v, u, placed_[v]);
}

template <class Real>
void TissueContact<Real>::before_step(const NodeShare& share, const Real* const /*u*/[3], const ConstraintStep& step)
{
  const double way = way_now(), response = physics::friction_response(step.dt);
  const Stage stage = clock_[0].stage;
  if (share.thread == 0)
  {
    next_ = clock_[0];
    next_.way = way;
    next_.dt = step.dt;
    if (stage == Stage::hold && way >= next_.renewal)
      next_.stage = Stage::sort;
    if (stage == Stage::sort)
    {
      sort_triangles();
      next_.stage = Stage::search;
    }
    if (stage == Stage::search)
    {
      next_.stage = Stage::hold;
      next_.renewal = way + renewal_share * reach_;
    }
  }
  if (rests())
    return;
  const auto [begin, end] = chunks_of(share);
  for (std::size_t c = begin; c < end; ++c)
  {
    Chunk& chunk = chunks_[c];
    if (stage != Stage::search && chunk.due > way)
      continue;
    chunk = { std::numeric_limits<double>::max(), 0 };
    for (std::size_t p = c * chunk_size; p < end_of(c); ++p)
    {
      if (stage == Stage::search)
        search(p);
      if (!(due_[p] > way))
        voxel_readings(p, way, response);
      chunk.due = std::min(chunk.due, due_[p]);
      for (std::size_t k = 0; k < most_tracks; ++k)
        chunk.touches |= tracks_[p * most_tracks + k].touches != Touching::no ? 1 : 0;
    }
  }
}

// Of a vertex in contact [N/m]; 0 where there is none: beyond a rim, or if the surfaces do not face each other.
template <class Real>
double TissueContact<Real>::stiffness(std::size_t p, std::int32_t t, const Foot& foot,
                                      const std::vector<Placed>& placed) const
{
  const auto& triangle = surface_.triangles[t];
  double share = ramp(-dot(foot.normal, placed[p].normal) / opposed) *
                 ramp((dot(foot.normal, foot.facet_normal) - least_upright) / (upright - least_upright));
  double per_area = 0, inside = 0;
  for (std::size_t i = 0; i < 3; ++i)
  {
    if (foot.weight[i] < 0 && triangle.neighbour[i] < 0)
      share *= ramp((foot.weight[i] + rim_end) / (rim_end - rim_begin));
    const double weight = std::max(foot.weight[i], 0.0);
    per_area += weight * double(per_area_[triangle.vertex[i]]);
    inside += weight;
  }
  // the softer of the two sides
  return share * double(stiffness_[p]) * std::min(1.0, per_area / (inside * double(per_area_[p])));
}

template <class Real>
typename TissueContact<Real>::PairForce TissueContact<Real>::touch(std::size_t p, Track& track,
                                                                   const std::vector<Placed>& placed, double response,
                                                                   double& gap) const
{
  const Foot foot = follow(track.triangle, placed[p].place, placed);
  gap = foot.gap - double(overlap_[p]);
  const double stiff = gap < 0 && gap > -deepest_held * surface_.edge ? stiffness(p, track.triangle, foot, placed) : 0;
  const double friction = model_.self_contacts[surface_.vertices[p].contact].friction;
  PairForce pair;
  physics::Grip<double> grip{ { 0, 0, 0 }, track.pressed, track.along };
  if (!(stiff > 0))
  {
    if (track.along > 0)
      pair.lost = physics::let_go<double>(grip, track.stiffness, response);
    else
      grip.normal -= response * grip.normal;
    if (friction == 0 || grip.normal <= double(stiffness_[p]) * physics::forgotten_depth)
      grip.normal = 0;
    const Touching now = track.touches == Touching::yes ? Touching::let_go : Touching::no;
    track = { track.triangle, now, 0, grip.normal, 0, { 0, 0, 0 } };
    return pair;
  }
  Vector way{ 0, 0, 0 };
  const auto& corners = surface_.triangles[track.triangle].vertex;
  if (track.touches == Touching::yes && friction > 0)
  {
    way = track.stretch + (placed[p].place - placed[p].before);
    for (int i = 0; i < 3; ++i)
      way = way - physics::carried(foot, i, placed[corners[i]].place - placed[corners[i]].before);
  }
  const auto held = physics::touch<double>({ gap, foot.gradient, 0, 0 }, way, grip, stiff, friction, response);
  const double pressed = -stiff * gap;
  const Vector along = held.force - pressed * foot.gradient;
  pair.point = held.force;
  const physics::SurfaceTriangle<double> triangle = surface_.triangle(track.triangle, placed);
  for (int i = 0; i < 3; ++i)
  {
    pair.corner[i] = physics::corner_force(triangle, foot, i, pressed, along);
    pair.turn[i] = physics::corner_turn(triangle, foot, i, pressed);
  }
  pair.stored = held.stored;
  pair.lost = held.lost;
  track = { track.triangle,   Touching::yes,   stiff,
            held.grip.normal, held.grip.along, (-1 / (physics::sticking_stiffness * stiff)) * along };
  return pair;
}

template <class Real>
void TissueContact<Real>::voxel_readings(std::size_t p, double way, double response)
{
  due_[p] = std::numeric_limits<double>::max();
  for (std::size_t k = p * most_tracks; k < (p + 1) * most_tracks; ++k)
  {
    Track& track = tracks_[k];
    if (track.triangle < 0)
      continue;
    double gap;
    pairs_[k] = touch(p, track, placed_, response, gap);
    // two may come to the same triangle
    if (k % most_tracks > 0 && track.triangle == tracks_[k - 1].triangle)
    {
      pairs_[k] = {};
      track = {};
      continue;
    }
    const bool holds = track.touches != Touching::no || track.pressed > 0;
    due_[p] = std::min(due_[p], holds ? way : way + (gap > 0 ? 0.5 * gap : patience * surface_.edge));
  }
}

// Adds up the forces on the vertices [begin, end), in the order of the vertices that touch.
template <class Real>
void TissueContact<Real>::add_vertex_forces(VertexForces& sum, const NodeShare& share, std::int32_t begin,
                                            std::int32_t end)
{
  const auto add = [&](std::int32_t v, const Vector& force, const Vector& turn)
  {
    if (v < begin || v >= end)
      return;
    sum.force[v] = sum.force[v] + force;
    sum.turn[v] = sum.turn[v] + turn;
    if (sum.touches[v] == 0)
      sum.touching.push_back(v);
    sum.touches[v] = 1;
  };
  for (std::size_t c = 0; c < chunks_.size(); ++c)
    for (std::size_t k = c * chunk_size * most_tracks; chunks_[c].touches != 0 && k < end_of(c) * most_tracks; ++k)
    {
      const Track& track = tracks_[k];
      if (track.touches == Touching::no)
        continue;
      const auto p = static_cast<std::int32_t>(k / most_tracks);
      if (const auto plane = model_.voxels[surface_.vertices[p].voxel][2];
          plane >= share.first_plane && plane < share.end_plane)
        lost_[plane] += pairs_[k].lost;
      if (track.touches == Touching::let_go)
        continue;
      add(p, pairs_[k].point, { 0, 0, 0 });
      for (std::size_t i = 0; i < 3; ++i)
        add(surface_.triangles[track.triangle].vertex[i], pairs_[k].corner[i], pairs_[k].turn[i]);
    }
}

template <class Real>
void TissueContact<Real>::add_forces(const NodeShare& share, const ForceSink<Real>& sink)
{
  const std::int32_t first = plane_points_[std::max(share.first_plane - 1, 0)], end = plane_points_[share.end_plane];
  VertexForces& sum = forces_[share.thread];
  add_vertex_forces(sum, share, first, end);
  for (const auto v : sum.touching)
  {
    push(v, sum.force[v], sum.turn[v], placed_[v], share,
         [&](std::int32_t node, const Vector& part) {
           sink(node, { { part.x, part.y, part.z } });
         });
    sum.force[v] = sum.turn[v] = { 0, 0, 0 };
    sum.touches[v] = 0;
  }
  sum.touching.clear();
  if (share.thread != 0)
    return;
  if (clock_[0].stage == Stage::search)
    mark_live();
  next_.earliest = std::numeric_limits<double>::max();
  for (const Chunk& chunk : chunks_)
    next_.earliest = std::min(next_.earliest, chunk.due);
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
  // The sums end at the start of the latest step. The rest is what the next step will add.
  std::vector<Placed> placed = placed_;
  for (std::size_t v = 0; v < placed.size(); ++v)
    surface_.place(v, u, placed[v]);
  const NodeShare all{ 0, 1, 0, model_.size[2] + 1, 0, static_cast<std::int32_t>(model_.nodes.size()) };
  const auto add = [&](std::size_t v, const Vector& force, const Vector& turn)
  {
    push(v, force, turn, placed[v], all,
         [&](std::int32_t node, const Vector& part) { add_vector(forces[node], part); });
  };
  for (std::size_t k = 0; k < tracks_.size(); ++k)
  {
    Track track = tracks_[k];
    if (track.triangle < 0)
      continue;
    double gap;
    const PairForce pair = touch(k / most_tracks, track, placed, physics::friction_response(clock_[0].dt), gap);
    stored += pair.stored;
    lost += pair.lost;
    if (track.touches != Touching::yes || forces.empty())
      continue;
    add(k / most_tracks, pair.point, { 0, 0, 0 });
    for (std::size_t i = 0; i < 3; ++i)
      add(surface_.triangles[track.triangle].vertex[i], pair.corner[i], pair.turn[i]);
  }
  if (open)
    opened_[0] = lost;
  ledger["contact_stored"] += stored;
  ledger["friction"] += lost - opened_[0];
}

template class TissueContact<float>;
template class TissueContact<double>;

}  // namespace frontalis
