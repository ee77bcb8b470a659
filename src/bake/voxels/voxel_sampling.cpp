#include "bake/voxels/block_classifier.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace frontalis
{

void BlockClassifier::sample(const Box& box, const BlockState& state)
{
  clear_shares();
  std::fill(gathered_.begin(), gathered_.end(), false);
  std::fill(nearby_.begin(), nearby_.end(), Nearby());
  // a little beside the centre: symmetric scenes have edges and corners there
  base_ = box.centre() + Vector3{ 0.0131 * grid_.spacing[0], 0.0073 * grid_.spacing[1], -0.0113 * grid_.spacing[2] };

  const double share = 1.0 / static_cast<double>(offsets_.size());
  std::vector<Answer> inside(state.volume.size());
  for (const Vector3& offset : offsets_)
  {
    Vector3 p{};
    for (std::size_t a = 0; a < 3; ++a)
      p[a] = box.lower[a] + offset[a] * grid_.spacing[a];
    std::fill(solid_here_.begin(), solid_here_.end(), std::int8_t{ -1 });
    std::fill(depth_here_.begin(), depth_here_.end(), std::numeric_limits<double>::quiet_NaN());

    bool tissue = false;
    for (std::size_t v = 0; v < inside.size(); ++v)
    {
      if (!volumes_.entries()[v].volume->tissue)
        continue;
      inside[v] = sample_volume(v, p, state) ? Answer::yes : Answer::no;
      tissue = tissue || inside[v] == Answer::yes;
    }
    if (!tissue)
      continue;
    for (std::size_t v = 0; v < inside.size(); ++v)
    {
      const Volumes::Entry& entry = volumes_.entries()[v];
      if (!entry.volume->tissue)
      {
        inside[v] = state.volume[v];
        if (inside[v] == Answer::unknown)
          inside[v] = sample_volume(v, p, state) ? Answer::yes : Answer::no;
      }
      if (inside[v] != Answer::yes)
        continue;
      volume_share_[v] += share;
      for (const Volumes::Band& band : entry.bands)
        sample_depth(static_cast<std::size_t>(band.depth), p, state);
    }
    count(inside, depth_here_, share);
  }
}

bool BlockClassifier::sample_volume(std::size_t volume, const Vector3& p, const BlockState& state)
{
  const Volumes::Entry& entry = volumes_.entries()[volume];
  if (!contains(entry.volume->crop, p))
    return false;
  if (entry.closed_by >= 0 && !sample_solid(static_cast<std::size_t>(entry.closed_by), p, state))
    return false;
  if (!entry.inside.empty() && std::none_of(entry.inside.begin(), entry.inside.end(),
                                            [&](int s) { return sample_solid(static_cast<std::size_t>(s), p, state); }))
    return false;
  if (entry.within >= 0)
  {
    const double depth = sample_depth(static_cast<std::size_t>(entry.within), p, state);
    if (depth < entry.volume->depth_min || depth > entry.volume->depth_max)
      return false;
  }
  if (std::any_of(entry.outside.begin(), entry.outside.end(),
                  [&](int s) { return sample_solid(static_cast<std::size_t>(s), p, state); }))
    return false;
  if (!entry.asks_sight() || state.sight[volume] != Answer::unknown)
    return !entry.asks_sight() || state.sight[volume] == Answer::yes;
  return in_sight(entry, p, entry.volume->depth_max + reach_);
}

bool BlockClassifier::sample_solid(std::size_t solid, const Vector3& p, const BlockState& state)
{
  if (state.solid[solid] != Answer::unknown)
    return state.solid[solid] == Answer::yes;
  std::int8_t& here = solid_here_[solid];
  if (here >= 0)
    return here != 0;
  const PreparedSurface& surface = *volumes_.solids()[solid].surface;
  Crossing& known = crossings_[solid];
  if (!gathered_[solid])
  {
    // the winding number at one point of the voxel; elsewhere it differs by the triangles between
    Box box;
    box.include(base_ - 0.52 * grid_.spacing);
    box.include(base_ + 0.52 * grid_.spacing);
    known.triangles.clear();
    surface.tree().gather(box, known.triangles);
    known.winding = surface.tree().winding_number(base_);
    known.variation = surface.closed() ? 0 : surface.winding_variation(base_, 1.1 * reach_);
    gathered_[solid] = true;
  }
  double winding = known.winding;
  for (const std::int32_t triangle : known.triangles)
    winding += crossing(surface.mesh(), triangle, base_, p);
  if (std::abs(winding - 0.5) <= known.variation)
    winding = surface.tree().winding_number(p);
  here = winding > 0.5 ? 1 : 0;
  return here != 0;
}

double BlockClassifier::sample_depth(std::size_t depth, const Vector3& p, const BlockState& state)
{
  double& here = depth_here_[depth];
  if (!std::isnan(here))
    return here;
  if (state.depth[depth].known)
    return here = state.depth[depth].depth;
  const Volumes::Depth& field = volumes_.depths()[depth];
  Nearby& nearby = nearby_[depth];
  if (!nearby.known)
  {
    const ClosestPoint closest = field.surface->tree().closest(base_);
    nearby.known = true;
    nearby.triangle = closest.triangle;
    nearby.distance = closest.distance;
    nearby.depth = -field.surface->signed_distance(base_, closest);
    nearby.steady = field.surface->closed() || !field.surface->rim_within(base_, closest.distance + 2.2 * reach_);
  }
  // depths change no faster than places: without a threshold between, that of the voxel's middle stands for this one
  const double way = norm(p - base_);
  const auto next = std::lower_bound(field.thresholds.begin(), field.thresholds.end(), nearby.depth - way);
  if (nearby.steady && (next == field.thresholds.end() || *next > nearby.depth + way))
    return here = nearby.depth;
  const ClosestPoint closest =
      field.surface->tree().closest(p, (nearby.distance + way) * (1 + 1e-9) + 1e-12, nearby.triangle);
  return here = -field.surface->signed_distance(p, closest);
}

void BlockClassifier::count_bands(const std::vector<Answer>& inside, const std::vector<double>& depth, double share)
{
  for (std::size_t v = 0; v < inside.size(); ++v)
  {
    const auto& bands = volumes_.entries()[v].bands;
    if (bands.empty() || inside[v] != Answer::yes)
      continue;
    const auto holds = [&depth](const Volumes::Band& band)
    {
      const double d = depth[static_cast<std::size_t>(band.depth)];
      return d >= band.from && d < band.to;
    };
    const auto band = std::find_if(bands.begin(), bands.end(), holds);
    band_share_[v][static_cast<std::size_t>(band - bands.begin())] += share;
  }
}

void BlockClassifier::count(const std::vector<Answer>& inside, const std::vector<double>& depth, double share)
{
  count_bands(inside, depth, share);
  // the highest priority among those that bring a material; equals share
  int highest = std::numeric_limits<int>::min();
  int sharers = 0;
  for (std::size_t v = 0; v < inside.size(); ++v)
  {
    const Volumes::Entry& entry = volumes_.entries()[v];
    if (inside[v] != Answer::yes)
      continue;
    if (entry.muscle >= 0)
      muscle_share_[static_cast<std::size_t>(entry.muscle)] += share;
    if (entry.material < 0 || entry.volume->priority < highest)
      continue;
    sharers = entry.volume->priority > highest ? 1 : sharers + 1;
    highest = entry.volume->priority;
  }
  for (std::size_t v = 0; v < inside.size(); ++v)
  {
    const Volumes::Entry& entry = volumes_.entries()[v];
    if (inside[v] != Answer::yes || entry.material < 0 || entry.volume->priority != highest)
      continue;
    int material = entry.material;
    for (const Volumes::Band& band : entry.bands)
    {
      const double d = depth[static_cast<std::size_t>(band.depth)];
      if (d >= band.from && d < band.to)
      {
        material = band.material;
        break;
      }
    }
    material_share_[static_cast<std::size_t>(material)] += share / sharers;
  }
}

void BlockClassifier::emit(const std::array<std::int32_t, 3>& place, double fill)
{
  voxels_.place.push_back(place);
  voxels_.fill.push_back(static_cast<float>(std::min(1.0, fill)));
  for (std::size_t m = 0; m < material_share_.size(); ++m)
  {
    if (material_share_[m] <= 0)
      continue;
    voxels_.material.push_back(static_cast<std::int16_t>(m));
    voxels_.proportion.push_back(static_cast<float>(material_share_[m] / fill));
  }
  voxels_.mixture_begin.push_back(static_cast<std::uint32_t>(voxels_.material.size()));
  for (std::size_t m = 0; m < muscle_share_.size(); ++m)
  {
    if (muscle_share_[m] <= 0)
      continue;
    voxels_.muscle.push_back(static_cast<std::int16_t>(m));
    voxels_.weight.push_back(static_cast<float>(std::min(1.0, muscle_share_[m] / fill)));
  }
  voxels_.muscle_begin.push_back(static_cast<std::uint32_t>(voxels_.muscle.size()));
}

}  // namespace frontalis
