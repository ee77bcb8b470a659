#include "solver/cpu/sleeping_tiles.hpp"

#include "solver/stepping/stepping_solver.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

constexpr double stir_share = 1.0 / 24;                                  // of the tolerance
constexpr double quiet_time = 0.05;                                      // [s]
constexpr int rings = 2;                                                 // around what has stirred
constexpr double first_nap = 0.1, longest_nap = 0.8, trial_time = 0.02;  // [s]
constexpr float activation_that_stirs = 1e-4F;

template <class Real>
double way_squared(const std::array<const Real*, 3>& u, const std::array<std::vector<float>, 3>& from, std::size_t node)
{
  double way = 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double x = double(u[axis][node]) - double(from[axis][node]);
    way += x * x;
  }
  return way;
}

}  // namespace

SleepingTiles::SleepingTiles(const Model& model, const VoxelRows& rows, double tolerance)
    : model_(model),
      rows_(rows),
      stir_(stir_share * tolerance),
      node_touched_(model.nodes.size(), 0),
      touched_(rows.tiles.size(), 0)
{
  for (const Load& load : model.loads)
    ramps_ = std::max(ramps_, load.ramp);
  reset();
}

void SleepingTiles::reset()
{
  State fresh;
  for (auto& component : fresh.anchor)
    component.assign(model_.nodes.size(), 0);
  fresh.stirred.assign(rows_.tiles.size(), 0);
  fresh.asleep.assign(rows_.tiles.size(), 0);
  fresh.activation.assign(model_.muscles.size(), 0);
  restore(fresh);
}

void SleepingTiles::State::archive(ByteArchive& archive)
{
  archive(anchor)(stirred)(asleep)(activation)(pose)(frequency_squared)(latest_frequency_squared);
  archive(before)(nap)(turn)(trial);
}

void SleepingTiles::restore(const State& state)
{
  state_ = state;
  sort();
}

void SleepingTiles::wake(double time)
{
  std::fill(state_.stirred.begin(), state_.stirred.end(), time);
  std::fill(state_.asleep.begin(), state_.asleep.end(), 0);
  state_.frequency_squared = 0;
  state_.nap = 0;
  state_.trial = false;
  sort();
}

// calls with the first node and the number of nodes of each row of a tile
template <class Visit>
void SleepingTiles::each_node(std::size_t tile, const Visit& visit) const
{
  const Tile& t = rows_.tiles[tile];
  for (int strip = 0; strip < Tile::strips && t.count[strip] > 0; ++strip)
    for (const std::int32_t first : t.node[strip])
      visit(first, t.count[strip] + 1);
}

// whether a nap or a trial ends now
template <class Real>
void SleepingTiles::nap_or_try(const std::array<const Real*, 3>& u, double time)
{
  if (state_.nap == 0 || time < state_.turn)
    return;
  auto& before = state_.before;
  state_.trial = !state_.trial;
  if (state_.trial)
  {
    for (int axis = 0; axis < 3; ++axis)
      before[axis].assign(u[axis], u[axis] + model_.nodes.size());
    state_.turn = time + trial_time;
    return;
  }
  double farthest = 0;
  for (std::size_t t = 0; t < state_.stirred.size(); ++t)
    if (time - state_.stirred[t] >= quiet_time)
      each_node(t,
                [&](std::int32_t first, std::int32_t count)
                {
                  for (auto n = first; n < first + count; ++n)
                    farthest = std::max(farthest, way_squared(u, before, n));
                });
  const double most = std::sqrt(farthest) > 0 ? stir_ / std::sqrt(farthest) : 2;
  state_.nap = std::clamp(state_.nap * std::min(2.0, most), first_nap, longest_nap);
  state_.turn = time + state_.nap;
}

template <class Real>
void SleepingTiles::look(const std::array<const Real*, 3>& u, const StepPlan& plan)
{
  std::vector<double> pose;
  for (const RigidTransform& bone : plan.end.bone)
  {
    pose.insert(pose.end(), bone.rotation.begin(), bone.rotation.end());
    pose.insert(pose.end(), bone.translation.begin(), bone.translation.end());
  }
  const bool moved = pose != state_.pose || plan.time < ramps_;
  state_.pose = pose;
  if (moved && !any())
    return wake(plan.time);
  std::fill(touched_.begin(), touched_.end(), moved ? 1 : 0);
  std::vector<char> switched(model_.muscles.size(), 0);
  for (std::size_t m = 0; m < switched.size(); ++m)
    if (std::abs(plan.end.activation[m] - state_.activation[m]) > activation_that_stirs)
    {
      switched[m] = 1;
      state_.activation[m] = plan.end.activation[m];
    }
  auto& anchor = state_.anchor;
  for (std::size_t n = 0; n < node_touched_.size(); ++n)
  {
    node_touched_[n] = way_squared(u, anchor, n) > stir_ * stir_;
    for (int axis = 0; axis < 3 && node_touched_[n] != 0; ++axis)
      anchor[axis][n] = static_cast<float>(u[axis][n]);
  }
  const std::size_t tiles = rows_.tiles.size();
  const auto touch_tiles = [&]
  {
    for (std::size_t t = 0; t < tiles; ++t)
      each_node(t,
                [&](std::int32_t first, std::int32_t count)
                {
                  for (auto n = first; n < first + count; ++n)
                    touched_[t] |= node_touched_[n];
                });
  };
  touch_tiles();
  for (std::size_t t = 0; t < tiles; ++t)
    for (auto f = rows_.tiles[t].fibre_begin; f < rows_.tiles[t].fibre_end; ++f)
      touched_[t] |= switched[rows_.fibres[f].muscle];
  for (int ring = 0; ring < rings; ++ring)
  {
    for (std::size_t t = 0; t < tiles; ++t)
      if (touched_[t] != 0)
        each_node(
            t, [&](std::int32_t first, std::int32_t count) { std::fill_n(node_touched_.begin() + first, count, 1); });
    touch_tiles();
  }
  for (std::size_t t = 0; t < tiles; ++t)
    if (touched_[t] != 0)
      state_.stirred[t] = plan.time;
  nap_or_try(u, plan.time);
  bool changed = false;
  for (std::size_t t = 0; t < tiles; ++t)
  {
    const char asleep = !state_.trial && plan.time - state_.stirred[t] >= quiet_time ? 1 : 0;
    changed = changed || asleep != state_.asleep[t];
    if (asleep > state_.asleep[t])
      state_.frequency_squared = std::max(state_.frequency_squared, state_.latest_frequency_squared);
    state_.asleep[t] = asleep;
  }
  if (changed)
    sort();
  if (any() && state_.nap == 0)
  {
    state_.nap = first_nap;
    state_.turn = plan.time + first_nap;
  }
  if (any())
    return;
  state_.frequency_squared = 0;
  if (!state_.trial)
    state_.nap = 0;
}

double SleepingTiles::frequency(double computed)
{
  state_.latest_frequency_squared = computed;
  return std::isfinite(computed) ? std::max(computed, state_.frequency_squared) : computed;
}

// what is awake, and which nodes are held
void SleepingTiles::sort()
{
  changed_ = true;
  const auto& asleep = state_.asleep;
  sleeping_ = static_cast<std::size_t>(std::count(asleep.begin(), asleep.end(), 1));
  awake_ = {};
  planes_.clear();
  held_.clear();
  plane_held_.assign(1, 0);
  if (!any())
  {
    planes_.push_back({ 0, rows_.planes });
    plane_held_.assign(static_cast<std::size_t>(rows_.planes) + 1, 0);
    return;
  }
  const std::size_t awake = asleep.size() - sleeping_;
  awake_.tiles.reserve(awake);
  awake_.stiffness.reserve(awake);
  awake_.stabilisation.reserve(rows_.stabilisation.empty() ? 0 : awake);
  node_held_.assign(model_.nodes.size(), 0);
  for (std::int32_t k = 0; k <= rows_.planes; ++k)
  {
    awake_.plane_tiles.push_back(static_cast<std::int32_t>(awake_.tiles.size()));
    for (auto t = rows_.plane_tiles[k]; k < rows_.planes && t < rows_.plane_tiles[k + 1]; ++t)
      if (asleep[t] == 0)
      {
        awake_.tiles.push_back(rows_.tiles[t]);
        awake_.stiffness.push_back(rows_.stiffness[t]);
        if (!rows_.stabilisation.empty())
          awake_.stabilisation.push_back(rows_.stabilisation[t]);
      }
      else
        each_node(t,
                  [&](std::int32_t first, std::int32_t count) { std::fill_n(node_held_.begin() + first, count, 1); });
  }
  const auto& begin = awake_.plane_tiles;
  for (std::int32_t k = 0; k < rows_.planes; ++k)
  {
    // the tiles above and below it
    if (begin[k] < begin[k + 1] || (k > 0 && begin[k - 1] < begin[k]))
    {
      if (planes_.empty() || planes_.back().second < k)
        planes_.push_back({ k, k });
      planes_.back().second = k + 1;
    }
    for (auto n = rows_.plane_nodes[k]; n < rows_.plane_nodes[k + 1]; ++n)
      if (node_held_[n] != 0)
      {
        const bool goes_on = static_cast<std::int32_t>(held_.size()) > plane_held_.back() &&
                             held_.back().first + held_.back().second == n;
        if (!goes_on)
          held_.push_back({ n, 0 });
        ++held_.back().second;
      }
    plane_held_.push_back(static_cast<std::int32_t>(held_.size()));
  }
}

void SleepingTiles::list_allocations(AllocationList& list) const
{
  for (const auto* field : { &state_.anchor, &state_.before })
    for (const auto& component : *field)
      list.add(Effect::elasticity, "what sleeps", component);
  list.add(Effect::elasticity, "what sleeps", state_.stirred);
  list.add(Effect::elasticity, "what sleeps", state_.asleep);
  list.add(Effect::elasticity, "what sleeps", node_touched_);
  list.add(Effect::elasticity, "what sleeps", node_held_);
  list.add(Effect::elasticity, "what sleeps", touched_);
  list.add(Effect::elasticity, "tiles that are awake", awake_.tiles);
  list.add(Effect::elasticity, "stiffness of tiles that are awake", awake_.stiffness);
  list.add(Effect::elasticity, "stiffness of tiles that are awake", awake_.stabilisation);
}

template void SleepingTiles::look(const std::array<const float*, 3>& u, const StepPlan& plan);
template void SleepingTiles::look(const std::array<const double*, 3>& u, const StepPlan& plan);

}  // namespace frontalis
