#include "bake/voxels/block_classifier.hpp"

namespace frontalis
{

void BlockClassifier::sample(const Box& box, const BlockState& state)
{
  share_ = nothing_;
  tissue_offset_.setZero();
  for (NearbyBody& body : nearby_body_)
    body.known = false;
  for (NearbyDepth& depth : nearby_depth_)
    depth.known = false;
  // avoid the exact centre, because scenes that are symmetric to the grid have edges and corners of surfaces there
  middle_ = box.center() + Vector3d(0.0131, 0.0073, -0.0113).cwiseProduct(grid_.spacing);

  const double share = 1.0 / static_cast<double>(offsets_.size());
  std::vector<Answer> inside(state.inside_volume.size());
  for (std::size_t s = 0; s < offsets_.size(); ++s)
  {
    if (chosen_ != nullptr && (*chosen_)[s] == 0)
      continue;
    const Vector3d p = box.min() + offsets_[s].cwiseProduct(grid_.spacing);
    std::fill(body_here_.begin(), body_here_.end(), std::int8_t{ -1 });
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
    if (is_tissue_ != nullptr)
      (*is_tissue_)[s] = 1;
    for (std::size_t v = 0; v < inside.size(); ++v)
    {
      const Volumes::Entry& entry = volumes_.entries()[v];
      if (!entry.volume->tissue)
      {
        inside[v] = state.inside_volume[v];
        if (inside[v] == Answer::unknown)
          inside[v] = sample_volume(v, p, state) ? Answer::yes : Answer::no;
      }
      if (inside[v] != Answer::yes)
        continue;
      share_.volume[v] += share;
      for (const Volumes::Band& band : entry.bands)
        sample_depth(band.depth_field, p, state);
    }
    const auto has_material = [&](const Volumes::Entry& entry)
    { return entry.material >= 0 && inside[&entry - volumes_.entries().data()] == Answer::yes; };
    if (std::any_of(volumes_.entries().begin(), volumes_.entries().end(), has_material))
      tissue_offset_ += share * offsets_[s];
    add_share(inside, depth_here_, share);
  }
}

bool BlockClassifier::sample_volume(std::size_t volume, const Vector3d& p, const BlockState& state)
{
  const Volumes::Entry& entry = volumes_.entries()[volume];
  const auto in_body = [&](std::size_t b) { return sample_body(b, p, state); };
  if (!to_box(entry.volume->crop).contains(p))
    return false;
  if (entry.closed_by && !in_body(*entry.closed_by))
    return false;
  if (!entry.inside.empty() && std::none_of(entry.inside.begin(), entry.inside.end(), in_body))
    return false;
  if (entry.within)
  {
    const double depth = sample_depth(*entry.within, p, state);
    if (depth < entry.volume->depth_min || depth > entry.volume->depth_max)
      return false;
  }
  if (std::any_of(entry.outside.begin(), entry.outside.end(), in_body))
    return false;
  if (!entry.needs_sight())
    return true;
  return state.in_sight[volume] == Answer::unknown ? in_sight(entry, p, entry.reach() + reach_)
                                                   : state.in_sight[volume] == Answer::yes;
}

bool BlockClassifier::sample_body(std::size_t body, const Vector3d& p, const BlockState& state)
{
  if (state.inside_body[body] != Answer::unknown)
    return state.inside_body[body] == Answer::yes;
  std::int8_t& here = body_here_[body];
  if (here >= 0)
    return here != 0;
  const PreparedSurface& surface = volumes_.body(body);
  NearbyBody& nearby = nearby_body_[body];
  if (!nearby.known)
  {
    nearby.triangles.clear();
    surface.tree().gather(Box(middle_ - 0.52 * grid_.spacing, middle_ + 0.52 * grid_.spacing), nearby.triangles);
    nearby.winding = surface.tree().winding_number(middle_);
    nearby.variation = surface.closed() ? 0 : surface.winding_variation(middle_, 1.1 * reach_);
    nearby.known = true;
  }
  // the winding number at p differs from that at the middle by the crossings of the triangles in between
  double winding = nearby.winding;
  for (const std::int32_t triangle : nearby.triangles)
    winding += crossing(surface.mesh(), triangle, middle_, p);
  if (std::abs(winding - 0.5) <= nearby.variation)
    winding = surface.tree().winding_number(p);
  here = winding > 0.5 ? 1 : 0;
  return here != 0;
}

double BlockClassifier::sample_depth(std::size_t field, const Vector3d& p, const BlockState& state)
{
  double& here = depth_here_[field];
  if (!std::isnan(here))
    return here;
  if (state.depth[field].known)
    return here = state.depth[field].value;
  const auto& [surface, thresholds] = volumes_.depth_fields()[field];
  NearbyDepth& nearby = nearby_depth_[field];
  if (!nearby.known)
  {
    const ClosestPoint closest = nearby.search.closest(middle_);
    nearby.known = true;
    nearby.distance = closest.distance;
    nearby.depth = -surface->signed_distance(middle_, closest);
    nearby.steady = surface->closed() || !surface->rim_within(middle_, closest.distance + 2.2 * reach_);
  }
  // Depths at two points differ by at most their distance. If no threshold is that near, use the middle's depth.
  const double way = (p - middle_).norm();
  const auto next = std::lower_bound(thresholds.begin(), thresholds.end(), nearby.depth - way);
  if (nearby.steady && (next == thresholds.end() || *next > nearby.depth + way))
    return here = nearby.depth;
  return here = -surface->signed_distance(p, nearby.search.closest(p, (nearby.distance + way) * (1 + 1e-9) + 1e-12));
}

void BlockClassifier::add_share(const std::vector<Answer>& inside, const std::vector<double>& depth, double share)
{
  // the volumes with the highest priority among those with a material share the sample equally
  int highest = std::numeric_limits<int>::min();
  int sharers = 0;
  for (std::size_t v = 0; v < inside.size(); ++v)
  {
    const Volumes::Entry& entry = volumes_.entries()[v];
    if (inside[v] != Answer::yes)
      continue;
    if (entry.muscle >= 0)
      share_.muscle[entry.muscle] += share;
    if (entry.material < 0 || entry.volume->priority < highest)
      continue;
    sharers = entry.volume->priority > highest ? 1 : sharers + 1;
    highest = entry.volume->priority;
  }
  for (std::size_t v = 0; v < inside.size(); ++v)
  {
    const Volumes::Entry& entry = volumes_.entries()[v];
    if (inside[v] != Answer::yes)
      continue;
    const auto band = std::find_if(entry.bands.begin(), entry.bands.end(),
                                   [&depth](const Volumes::Band& b)
                                   { return depth[b.depth_field] >= b.from && depth[b.depth_field] < b.to; });
    if (!entry.bands.empty())
      share_.band[v][band - entry.bands.begin()] += share;
    if (entry.material >= 0 && entry.volume->priority == highest)
      share_.material[band == entry.bands.end() ? entry.material : band->material] += share / sharers;
  }
}

void BlockClassifier::add_voxel(const VoxelPlace& place, double fill, const Vector3d& centre)
{
  voxels_.place.push_back(place);
  voxels_.fill.push_back(static_cast<float>(std::min(1.0, fill)));
  const bool cut = fill < 1 - 1e-9;
  const auto inside = [cut](double x) { return cut ? static_cast<float>(std::clamp(x, -1.0, 1.0)) : 0.0F; };
  voxels_.centre.push_back({ inside(centre[0]), inside(centre[1]), inside(centre[2]) });
  voxels_.materials.add(share_.material, fill);
  voxels_.muscles.add(share_.muscle, fill);
}

}  // namespace frontalis
