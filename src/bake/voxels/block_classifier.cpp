#include "bake/voxels/block_classifier.hpp"

#include "frontalis/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace frontalis
{
namespace
{

constexpr double deep = std::numeric_limits<double>::infinity();

}  // namespace

BlockClassifier::BlockClassifier(const Volumes& volumes, const Grid& grid, int samples, double fill_min)
    : volumes_(volumes),
      grid_(grid),
      fill_min_(fill_min),
      voxel_volume_(grid.spacing[0] * grid.spacing[1] * grid.spacing[2]),
      reach_(0.5 * norm(grid.spacing)),
      crossings_(volumes.solids().size()),
      gathered_(volumes.solids().size()),
      nearby_(volumes.depths().size()),
      solid_here_(volumes.solids().size()),
      depth_here_(volumes.depths().size())
{
  // R3 sequence: steps 1/g, 1/g^2, 1/g^3 with g^4 = g + 1
  const Vector3 step{ 0.8191725133961645, 0.6710436067037893, 0.5497004779019703 };
  for (int s = 0; s < samples * samples * samples; ++s)
    offsets_.push_back(
        { std::fmod(0.5 + s * step[0], 1.0), std::fmod(0.5 + s * step[1], 1.0), std::fmod(0.5 + s * step[2], 1.0) });
  voxels_.volume_size.assign(volumes.entries().size(), 0);
  volume_share_.assign(volumes.entries().size(), 0);
  int materials = 0, muscles = 0;
  for (const Volumes::Entry& entry : volumes.entries())
  {
    materials = std::max(materials, entry.material + 1);
    muscles = std::max(muscles, entry.muscle + 1);
    band_share_.emplace_back(entry.bands.empty() ? 0 : entry.bands.size() + 1, 0);
    for (const Volumes::Band& band : entry.bands)
      materials = std::max(materials, band.material + 1);
  }
  voxels_.band_size = band_share_;
  material_share_.assign(static_cast<std::size_t>(materials), 0);
  muscle_share_.assign(static_cast<std::size_t>(muscles), 0);
}

void BlockClassifier::visit(const std::array<std::int32_t, 3>& begin, const std::array<std::int32_t, 3>& end)
{
  BlockState state;
  state.solid.assign(volumes_.solids().size(), Answer::unknown);
  state.depth.resize(volumes_.depths().size());
  state.volume.assign(volumes_.entries().size(), Answer::unknown);
  state.sight.assign(volumes_.entries().size(), Answer::unknown);
  visit(begin, end, state);
}

void BlockClassifier::visit(const std::array<std::int32_t, 3>& begin, const std::array<std::int32_t, 3>& end,
                            BlockState state)
{
  Box box;
  bool single = true;
  for (std::size_t a = 0; a < 3; ++a)
  {
    box.lower[a] = grid_.lower[a] + begin[a] * grid_.spacing[a];
    box.upper[a] = grid_.lower[a] + end[a] * grid_.spacing[a];
    single = single && end[a] - begin[a] == 1;
  }
  const bool known = settle(box, state);
  bool tissue = false;
  for (std::size_t v = 0; v < state.volume.size(); ++v)
    tissue = tissue || (volumes_.entries()[v].volume->tissue && state.volume[v] != Answer::no);
  if (!tissue)
    return;

  if (known)
  {
    clear_shares();
    std::vector<double> depth;
    for (const auto& interval : state.depth)
      depth.push_back(interval.depth);
    count(state.volume, depth, 1);
    double voxels = 0;
    for (std::int32_t k = begin[2]; k < end[2]; ++k)
      for (std::int32_t j = begin[1]; j < end[1]; ++j)
        for (std::int32_t i = begin[0]; i < end[0]; ++i, ++voxels)
          emit({ i, j, k }, 1);
    for (std::size_t v = 0; v < state.volume.size(); ++v)
      volume_share_[v] = state.volume[v] == Answer::yes ? 1 : 0;
    add_sizes(voxels);
    return;
  }
  if (single)
  {
    sample(box, state);
    double fill = 0;
    for (const double share : material_share_)
      fill += share;
    add_sizes(1);
    if (fill > 0 && fill >= fill_min_)
      emit(begin, fill);
    return;
  }

  // halves along each side that is longer than a voxel
  std::array<std::int32_t, 3> middle{};
  for (std::size_t a = 0; a < 3; ++a)
    middle[a] = begin[a] + (end[a] - begin[a] + 1) / 2;
  for (int part = 0; part < 8; ++part)
  {
    std::array<std::int32_t, 3> from{}, to{};
    bool empty = false;
    for (std::size_t a = 0; a < 3; ++a)
    {
      const bool upper = (part >> a & 1) != 0;
      from[a] = upper ? middle[a] : begin[a];
      to[a] = upper ? end[a] : middle[a];
      empty = empty || from[a] >= to[a];
    }
    if (!empty)
      visit(from, to, state);
  }
}

void BlockClassifier::clear_shares()
{
  std::fill(material_share_.begin(), material_share_.end(), 0);
  std::fill(muscle_share_.begin(), muscle_share_.end(), 0);
  std::fill(volume_share_.begin(), volume_share_.end(), 0);
  for (auto& bands : band_share_)
    std::fill(bands.begin(), bands.end(), 0);
}

void BlockClassifier::add_sizes(double voxels)
{
  for (std::size_t v = 0; v < volume_share_.size(); ++v)
  {
    voxels_.volume_size[v] += volume_share_[v] * voxels * voxel_volume_;
    for (std::size_t b = 0; b < band_share_[v].size(); ++b)
      voxels_.band_size[v][b] += band_share_[v][b] * voxels * voxel_volume_;
  }
}

bool BlockClassifier::settle(const Box& box, BlockState& state)
{
  // tissue first: where there is none, nothing else is asked
  const auto ask = [&](std::size_t v)
  {
    if (state.volume[v] != Answer::unknown)
      return;
    const Volumes::Entry& entry = volumes_.entries()[v];
    state.volume[v] = volume_answer(v, box, state);
    const auto solid = [&](int s)
    {
      if (s >= 0 && state.volume[v] == Answer::unknown && state.solid[static_cast<std::size_t>(s)] == Answer::unknown)
      {
        settle_solid(static_cast<std::size_t>(s), box, state);
        state.volume[v] = volume_answer(v, box, state);
      }
    };
    if (state.volume[v] == Answer::unknown && entry.within >= 0 &&
        !state.depth[static_cast<std::size_t>(entry.within)].known)
    {
      settle_depth(static_cast<std::size_t>(entry.within), box, state);
      state.volume[v] = volume_answer(v, box, state);
    }
    solid(entry.closed_by);
    for (const int s : entry.inside)
      solid(s);
    for (const int s : entry.outside)
      solid(s);
    if (entry.asks_sight() && state.volume[v] == Answer::unknown && state.sight[v] == Answer::unknown)
    {
      settle_sight(v, box, state);
      state.volume[v] = volume_answer(v, box, state);
    }
  };
  bool tissue = false;
  for (std::size_t v = 0; v < state.volume.size(); ++v)
  {
    if (!volumes_.entries()[v].volume->tissue)
      continue;
    ask(v);
    tissue = tissue || state.volume[v] != Answer::no;
  }
  if (!tissue)
    return true;
  bool known = true;
  for (std::size_t v = 0; v < state.volume.size(); ++v)
  {
    if (!volumes_.entries()[v].volume->tissue)
      ask(v);
    known = known && state.volume[v] != Answer::unknown;
  }
  for (std::size_t v = 0; v < state.volume.size(); ++v)
  {
    if (state.volume[v] == Answer::no)
      continue;
    for (const Volumes::Band& band : volumes_.entries()[v].bands)
    {
      if (!state.depth[static_cast<std::size_t>(band.depth)].known)
        settle_depth(static_cast<std::size_t>(band.depth), box, state);
    }
  }
  return known && layers_known(state);
}

bool BlockClassifier::layers_known(const BlockState& state) const
{
  for (std::size_t v = 0; v < state.volume.size(); ++v)
  {
    if (state.volume[v] == Answer::no)
      continue;
    for (const Volumes::Band& band : volumes_.entries()[v].bands)
    {
      if (!state.depth[static_cast<std::size_t>(band.depth)].known)
        return false;
    }
  }
  return true;
}

void BlockClassifier::settle_solid(std::size_t solid, const Box& box, BlockState& state) const
{
  const PreparedSurface& surface = *volumes_.solids()[solid].surface;
  if (surface.closed() && !surface.box().overlaps(box))
  {
    state.solid[solid] = Answer::no;
    return;
  }
  if (surface.tree().overlaps(box))
    return;
  const Vector3 centre = box.centre();
  const double winding = surface.tree().winding_number(centre);
  if (!surface.closed() &&
      std::abs(winding - 0.5) <= surface.winding_variation(centre, norm(box.upper - centre)) + 0.01)
    return;
  state.solid[solid] = winding > 0.5 ? Answer::yes : Answer::no;
}

void BlockClassifier::settle_depth(std::size_t depth, const Box& box, BlockState& state) const
{
  const Volumes::Depth& field = volumes_.depths()[depth];
  const Vector3 centre = box.centre();
  const double radius = norm(box.upper - centre);
  const double farthest = std::max(std::abs(field.thresholds.front()), std::abs(field.thresholds.back()));
  const ClosestPoint closest = field.surface->tree().closest(centre, farthest + radius);
  if (closest.triangle < 0)
  {
    state.depth[depth] = { true, deep };
    return;
  }
  const double signed_depth = -field.surface->signed_distance(centre, closest);
  double low = signed_depth - radius, high = signed_depth + radius;
  // near the rim of an open surface the sign may change without passing through it
  if (!field.surface->closed() && field.surface->rim_within(centre, closest.distance + 2 * radius))
  {
    high = closest.distance + radius;
    low = -high;
  }
  for (const double threshold : field.thresholds)
  {
    if (threshold >= low && threshold <= high)
      return;
  }
  state.depth[depth] = { true, signed_depth };
}

void BlockClassifier::settle_sight(std::size_t volume, const Box& box, BlockState& state) const
{
  // a box without a piece of an `outside` surface lies on one side of them
  const Volumes::Entry& entry = volumes_.entries()[volume];
  const auto hiding = entry.outside.begin() + static_cast<std::ptrdiff_t>(entry.hiding);
  if (std::any_of(entry.outside.begin(), hiding,
                  [&](int s) { return state.solid[static_cast<std::size_t>(s)] == Answer::unknown; }))
    return;
  const Vector3 centre = box.centre();
  const double radius = norm(box.upper - centre);
  const double bound = entry.volume->depth_max + radius;
  const Volumes::Depth& field = volumes_.depths()[static_cast<std::size_t>(entry.within)];
  const ClosestPoint closest = field.surface->tree().closest(centre, bound);
  if (closest.triangle < 0)
    return;
  const auto away = [&](int s)
  {
    const PreparedSurface& surface = *volumes_.solids()[static_cast<std::size_t>(s)].surface;
    return surface.tree().closest(centre, closest.distance + 2 * radius).triangle < 0;
  };
  if (std::all_of(entry.outside.begin(), hiding, away))
    state.sight[volume] = Answer::yes;
  else if (radius < 1.001 * reach_)
    state.sight[volume] = in_sight(entry, centre, bound) ? Answer::yes : Answer::no;
}

bool BlockClassifier::in_sight(const Volumes::Entry& entry, const Vector3& p, double bound) const
{
  const Volumes::Depth& field = volumes_.depths()[static_cast<std::size_t>(entry.within)];
  const ClosestPoint closest = field.surface->tree().closest(p, bound);
  return closest.triangle >= 0 &&
         std::none_of(
             entry.outside.begin(), entry.outside.begin() + static_cast<std::ptrdiff_t>(entry.hiding),
             [&](int s)
             { return volumes_.solids()[static_cast<std::size_t>(s)].surface->tree().crossed_by(p, closest.point); });
}

Answer BlockClassifier::volume_answer(std::size_t volume, const Box& box, const BlockState& state) const
{
  const Volumes::Entry& entry = volumes_.entries()[volume];
  bool unknown = false;
  const auto solid = [&](int s) { return state.solid[static_cast<std::size_t>(s)]; };
  for (std::size_t a = 0; a < 3; ++a)
  {
    const Region& crop = entry.volume->crop;
    if (box.upper[a] <= crop.lower[a] || box.lower[a] >= crop.upper[a])
      return Answer::no;
    unknown = unknown || box.lower[a] < crop.lower[a] || box.upper[a] > crop.upper[a];
  }
  if (entry.closed_by >= 0)
  {
    if (solid(entry.closed_by) == Answer::no)
      return Answer::no;
    unknown = unknown || solid(entry.closed_by) == Answer::unknown;
  }
  if (!entry.inside.empty())
  {
    Answer any = Answer::no;
    for (const int s : entry.inside)
    {
      if (solid(s) == Answer::yes)
        any = Answer::yes;
      else if (solid(s) == Answer::unknown && any == Answer::no)
        any = Answer::unknown;
    }
    if (any == Answer::no)
      return Answer::no;
    unknown = unknown || any == Answer::unknown;
  }
  for (const int s : entry.outside)
  {
    if (solid(s) == Answer::yes)
      return Answer::no;
    unknown = unknown || solid(s) == Answer::unknown;
  }
  if (entry.within >= 0)
  {
    const BlockState::Interval& interval = state.depth[static_cast<std::size_t>(entry.within)];
    if (interval.known && (interval.depth < entry.volume->depth_min || interval.depth > entry.volume->depth_max))
      return Answer::no;
    unknown = unknown || !interval.known;
  }
  if (entry.asks_sight())
  {
    if (state.sight[volume] == Answer::no)
      return Answer::no;
    unknown = unknown || state.sight[volume] == Answer::unknown;
  }
  return unknown ? Answer::unknown : Answer::yes;
}

}  // namespace frontalis
