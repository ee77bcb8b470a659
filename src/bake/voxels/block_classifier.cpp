#include "bake/voxels/block_classifier.hpp"

#include <numeric>

namespace frontalis
{

BlockClassifier::BlockClassifier(const Volumes& volumes, const Grid& grid, int samples, double fill_min,
                                 const std::vector<const PreparedSurface*>& kept_at)
    : volumes_(volumes),
      grid_(grid),
      fill_min_(fill_min),
      kept_at_(kept_at),
      voxel_volume_(grid.spacing[0] * grid.spacing[1] * grid.spacing[2]),
      reach_(0.5 * grid.spacing.norm()),
      nearby_body_(volumes.bodies()),
      body_here_(volumes.bodies()),
      depth_here_(volumes.depth_fields().size())
{
  // the cubes are a little larger than a voxel, because their centre middle_ is beside the centre of the voxel
  for (const auto& field : volumes.depth_fields())
    nearby_depth_.push_back({ ClusterSearch(field.surface->tree(), 1.03 * grid.spacing.maxCoeff()) });
  // the first sample is the middle of the voxel
  for (int s = 0; s < samples * samples * samples; ++s)
  {
    offsets_.push_back(spread_point(Box(Vector3d::Zero(), Vector3d::Ones()), s - 1));
    mean_offset_ += offsets_.back() / (samples * samples * samples);
  }
  voxels_.volume_size.assign(volumes.entries().size(), 0);
  int materials = 0, muscles = 0;
  for (const Volumes::Entry& entry : volumes.entries())
  {
    materials = std::max(materials, entry.material + 1);
    muscles = std::max(muscles, entry.muscle + 1);
    nothing_.band.emplace_back(entry.bands.empty() ? 0 : entry.bands.size() + 1, 0);
    for (const Volumes::Band& band : entry.bands)
      materials = std::max(materials, band.material + 1);
  }
  nothing_.material.assign(materials, 0);
  nothing_.muscle.assign(muscles, 0);
  nothing_.volume = voxels_.volume_size;
  voxels_.band_size = nothing_.band;
}

BlockState BlockClassifier::unknown() const
{
  BlockState state;
  state.inside_body.assign(volumes_.bodies(), Answer::unknown);
  state.depth.resize(volumes_.depth_fields().size());
  state.inside_volume.assign(volumes_.entries().size(), Answer::unknown);
  state.in_sight.assign(volumes_.entries().size(), Answer::unknown);
  return state;
}

void BlockClassifier::visit(const VoxelPlace& begin, const VoxelPlace& end) { visit(begin, end, unknown()); }

void BlockClassifier::sample_alone(const VoxelPlace& place)
{
  const VoxelPlace end{ { place[0] + 1, place[1] + 1, place[2] + 1 } };
  BlockState state = unknown();
  const Box box(grid_.corner(place), grid_.corner(end));
  decide(box, state);
  sample(box, state);
}

std::vector<char> BlockClassifier::tissue_samples(const VoxelPlace& place)
{
  std::vector<char> tissue(offsets_.size(), 0);
  is_tissue_ = &tissue;
  sample_alone(place);
  is_tissue_ = nullptr;
  return tissue;
}

void BlockClassifier::add_part(const VoxelPlace& place, const std::vector<char>& chosen)
{
  chosen_ = &chosen;
  sample_alone(place);
  chosen_ = nullptr;
  const double fill = std::accumulate(share_.material.begin(), share_.material.end(), 0.0);
  add_voxel(place, fill, 2 * (tissue_offset_ / fill - mean_offset_));
}

void BlockClassifier::visit(const VoxelPlace& begin, const VoxelPlace& end, BlockState state)
{
  const Box box(grid_.corner(begin), grid_.corner(end));
  const bool known = decide(box, state);
  bool tissue = false;
  for (std::size_t v = 0; v < state.inside_volume.size(); ++v)
    tissue = tissue || (volumes_.entries()[v].volume->tissue && state.inside_volume[v] != Answer::no);
  if (!tissue)
    return;

  if (known)
  {
    share_ = nothing_;
    std::vector<double> depth;
    for (const auto& d : state.depth)
      depth.push_back(d.value);
    add_share(state.inside_volume, depth, 1);
    double voxels = 0;
    for (std::int32_t k = begin[2]; k < end[2]; ++k)
      for (std::int32_t j = begin[1]; j < end[1]; ++j)
        for (std::int32_t i = begin[0]; i < end[0]; ++i, ++voxels)
          add_voxel({ i, j, k }, 1, Vector3d::Zero());
    for (std::size_t v = 0; v < state.inside_volume.size(); ++v)
      share_.volume[v] = state.inside_volume[v] == Answer::yes ? 1 : 0;
    add_sizes(voxels);
    return;
  }
  if (end == VoxelPlace{ begin[0] + 1, begin[1] + 1, begin[2] + 1 })
  {
    sample(box, state);
    const double fill = std::accumulate(share_.material.begin(), share_.material.end(), 0.0);
    add_sizes(1);
    const auto passes = [&box](const PreparedSurface* surface) { return surface->tree().overlaps(box); };
    if (fill > 0 && (fill >= fill_min_ || std::any_of(kept_at_.begin(), kept_at_.end(), passes)))
      add_voxel(begin, fill, 2 * (tissue_offset_ / fill - mean_offset_));
    return;
  }

  // halve the block along each side that is longer than a voxel
  for (int part = 0; part < 8; ++part)
  {
    VoxelPlace from{}, to{};
    bool empty = false;
    for (int a = 0; a < 3; ++a)
    {
      const std::int32_t middle = begin[a] + (end[a] - begin[a] + 1) / 2;
      const bool upper = (part >> a & 1) != 0;
      from[a] = upper ? middle : begin[a];
      to[a] = upper ? end[a] : middle;
      empty = empty || from[a] >= to[a];
    }
    if (!empty)
      visit(from, to, state);
  }
}

void BlockClassifier::add_sizes(double voxels)
{
  for (std::size_t v = 0; v < share_.volume.size(); ++v)
  {
    voxels_.volume_size[v] += share_.volume[v] * voxels * voxel_volume_;
    for (std::size_t b = 0; b < share_.band[v].size(); ++b)
      voxels_.band_size[v][b] += share_.band[v][b] * voxels * voxel_volume_;
  }
}

void BlockClassifier::decide_volume(std::size_t volume, const Box& box, BlockState& state)
{
  const Volumes::Entry& entry = volumes_.entries()[volume];
  Answer& answer = state.inside_volume[volume];
  if (answer != Answer::unknown)
    return;
  answer = volume_answer(volume, box, state);
  // evaluate cheap conditions first, and others only while the answer is unknown
  const auto ask = [&](bool known, const auto& decide)
  {
    if (known || answer != Answer::unknown)
      return;
    decide();
    answer = volume_answer(volume, box, state);
  };
  const auto ask_body = [&](std::size_t b)
  { ask(state.inside_body[b] != Answer::unknown, [&] { decide_body(b, box, state); }); };
  if (entry.within)
    ask(state.depth[*entry.within].known, [&] { decide_depth(*entry.within, box, state); });
  if (entry.closed_by)
    ask_body(*entry.closed_by);
  std::for_each(entry.inside.begin(), entry.inside.end(), ask_body);
  std::for_each(entry.outside.begin(), entry.outside.end(), ask_body);
  if (entry.needs_sight())
    ask(state.in_sight[volume] != Answer::unknown, [&] { decide_sight(volume, box, state); });
}

bool BlockClassifier::decide(const Box& box, BlockState& state)
{
  // decide tissue volumes first: without tissue nothing else needs to be known
  bool tissue = false;
  for (std::size_t v = 0; v < state.inside_volume.size(); ++v)
  {
    if (!volumes_.entries()[v].volume->tissue)
      continue;
    decide_volume(v, box, state);
    tissue = tissue || state.inside_volume[v] != Answer::no;
  }
  if (!tissue)
    return true;
  bool known = true;
  for (std::size_t v = 0; v < state.inside_volume.size(); ++v)
  {
    if (!volumes_.entries()[v].volume->tissue)
      decide_volume(v, box, state);
    known = known && state.inside_volume[v] != Answer::unknown;
    if (state.inside_volume[v] == Answer::no)
      continue;
    for (const Volumes::Band& band : volumes_.entries()[v].bands)
    {
      if (!state.depth[band.depth_field].known)
        decide_depth(band.depth_field, box, state);
      known = known && state.depth[band.depth_field].known;
    }
  }
  return known;
}

void BlockClassifier::decide_body(std::size_t body, const Box& box, BlockState& state) const
{
  const PreparedSurface& surface = volumes_.body(body);
  if (surface.closed() && !surface.box().intersects(box))
  {
    state.inside_body[body] = Answer::no;
    return;
  }
  if (surface.tree().overlaps(box))
    return;
  const Vector3d centre = box.center();
  const double winding = surface.tree().winding_number(centre);
  const double radius = (box.max() - centre).norm();
  if (!surface.closed() && std::abs(winding - 0.5) <= surface.winding_variation(centre, radius) + 0.01)
    return;
  state.inside_body[body] = winding > 0.5 ? Answer::yes : Answer::no;
}

void BlockClassifier::decide_depth(std::size_t field, const Box& box, BlockState& state) const
{
  const auto& [surface, thresholds] = volumes_.depth_fields()[field];
  const Vector3d centre = box.center();
  const double radius = (box.max() - centre).norm();
  const double farthest = std::max(std::abs(thresholds.front()), std::abs(thresholds.back()));
  const ClosestPoint closest = surface->tree().closest(centre, farthest + radius);
  if (closest.triangle < 0)
  {
    // the surface is farther from the whole block than the largest threshold
    state.depth[field] = { true, std::numeric_limits<double>::infinity() };
    return;
  }
  const double depth = -surface->signed_distance(centre, closest);
  double low = depth - radius, high = depth + radius;
  // near the border of an open surface the depth may change sign without passing 0
  if (!surface->closed() && surface->rim_within(centre, closest.distance + 2 * radius))
  {
    high = closest.distance + radius;
    low = -high;
  }
  if (std::none_of(thresholds.begin(), thresholds.end(), [=](double t) { return t >= low && t <= high; }))
    state.depth[field] = { true, depth };
}

void BlockClassifier::decide_sight(std::size_t volume, const Box& box, BlockState& state) const
{
  // the answer is undecided as long as a hiding surface may pass through the block
  const Volumes::Entry& entry = volumes_.entries()[volume];
  if (entry.any_hiding([&](std::size_t b) { return state.inside_body[b] == Answer::unknown; }))
    return;
  const Vector3d centre = box.center();
  const double radius = (box.max() - centre).norm();
  const double bound = entry.reach() + radius;
  const ClosestPoint closest = volumes_.depth_fields()[*entry.within].surface->tree().closest(centre, bound);
  if (closest.triangle < 0)
    return;
  const auto is_near = [&](std::size_t b)
  { return volumes_.body(b).tree().closest(centre, closest.distance + 2 * radius).triangle >= 0; };
  if (!entry.any_hiding(is_near))
    state.in_sight[volume] = Answer::yes;
  else if (radius < 1.001 * reach_)
    state.in_sight[volume] = in_sight(entry, centre, bound) ? Answer::yes : Answer::no;
}

bool BlockClassifier::in_sight(const Volumes::Entry& entry, const Vector3d& p, double bound) const
{
  const ClosestPoint closest = volumes_.depth_fields()[*entry.within].surface->tree().closest(p, bound);
  return closest.triangle >= 0 &&
         !entry.any_hiding([&](std::size_t b) { return volumes_.body(b).tree().crossed_by(p, closest.point); });
}

Answer BlockClassifier::volume_answer(std::size_t volume, const Box& box, const BlockState& state) const
{
  // a volume is the intersection of its conditions
  const Volumes::Entry& entry = volumes_.entries()[volume];
  Answer all = Answer::yes;
  const auto require = [&all](Answer condition)
  {
    if (condition == Answer::no || all == Answer::no)
      all = Answer::no;
    else if (condition == Answer::unknown)
      all = Answer::unknown;
  };
  const auto in_body = [&](std::size_t b) { return state.inside_body[b]; };
  const Box crop = to_box(entry.volume->crop);
  if ((box.max().array() <= crop.min().array()).any() || (box.min().array() >= crop.max().array()).any())
    return Answer::no;
  require(crop.contains(box) ? Answer::yes : Answer::unknown);
  if (entry.closed_by)
    require(in_body(*entry.closed_by));
  if (!entry.inside.empty())
  {
    const auto any = [&](Answer wanted) {
      return std::any_of(entry.inside.begin(), entry.inside.end(), [&](std::size_t b) { return in_body(b) == wanted; });
    };
    require(any(Answer::yes) ? Answer::yes : any(Answer::unknown) ? Answer::unknown : Answer::no);
  }
  for (const std::size_t b : entry.outside)
    require(in_body(b) == Answer::yes ? Answer::no : in_body(b) == Answer::no ? Answer::yes : Answer::unknown);
  if (entry.within)
  {
    const auto [known, depth] = state.depth[*entry.within];
    const bool within = depth >= entry.volume->depth_min && depth <= entry.volume->depth_max;
    require(!known ? Answer::unknown : within ? Answer::yes : Answer::no);
  }
  if (entry.needs_sight())
    require(state.in_sight[volume]);
  return all;
}

}  // namespace frontalis
