#include "bake/voxels/gaps.hpp"

#include "bake/messages.hpp"

#include <boost/pending/disjoint_sets.hpp>

#include <map>
#include <numeric>
#include <unordered_set>

namespace frontalis
{
namespace
{

constexpr int points_per_edge = 6;
constexpr double reach = 0.45;  // largest distance of points that are tested for a joint, in voxel edges

using Way = GapWalls::Way;
using Sets = boost::disjoint_sets_with_storage<>;

/// Whether tissue that no pair of points joins stays whole: most of its pairs are not parted by a slit, but by the
/// continuation beyond its border. This is so where the tissue itself ends just beyond the slit, as at the skin. In a
/// voxel full of tissue a slit that leaves no joint crosses at least half of the pairs; two thirds that it does not
/// cross leave a margin for chance.
bool mostly_beyond(std::size_t beyond, std::size_t cut) { return beyond > 2 * cut; }

std::uint64_t pair_of(std::uint32_t a, std::uint32_t b)
{
  return std::uint64_t{ std::min(a, b) } << 32 | std::max(a, b);
}

VoxelPlace sum(const VoxelPlace& a, int i, int j, int k) { return { { a[0] + i, a[1] + j, a[2] + k } }; }

/// Calls call(neighbour) for the 26 neighbours of a place, or for those that come after the place in the grid.
template <class Call>
void each_neighbour(const VoxelPlace& place, bool half, const Call& call)
{
  for (int n = half ? 14 : 0; n < 27; ++n)
    if (n != 13)
      call(sum(place, n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1));
}

}  // namespace

Gaps::Gaps(const Scene& scene, const Volumes& volumes, const PreparedSurfaces& surfaces, const Grid& grid)
    : scene_(scene),
      volumes_(volumes),
      grid_(grid),
      surfaces_(surfaces),
      thin_gaps_(scene.accuracy.gaps == "parted"),
      samples_(scene.accuracy.samples)
{
}

std::size_t Gaps::cell(const VoxelPlace& place) const
{
  return (std::size_t{ 1 } * place[2] * grid_.size[1] + place[1]) * grid_.size[0] + place[0];
}

Gaps::Level Gaps::level(const VoxelPlace& place) const
{
  for (int a = 0; a < 3; ++a)
    if (place[a] < 0 || place[a] >= grid_.size[a])
      return Level::far;
  return level_.empty() ? Level::far : level_[cell(place)];
}

const Gaps::Tissue* Gaps::tissue_at(const VoxelPlace& place) const
{
  if (level(place) == Level::far)
    return nullptr;
  const std::int32_t index = tissue_of_[cell(place)];
  return index < 0 ? nullptr : &tissue_[index];
}

void Gaps::mark(const Voxels& voxels, BakeMonitor& monitor)
{
  const bool any_slit = std::any_of(scene_.volumes.begin(), scene_.volumes.end(),
                                    [](const Volume& volume) { return !volume.slits.empty(); });
  if (!thin_gaps_ && !any_slit)
    return;
  walls_.emplace(volumes_, surfaces_, grid_.spacing);
  const std::vector<char> gaps = walls_->cells_with_gaps(volumes_, grid_, thin_gaps_, monitor);
  if (std::find(gaps.begin(), gaps.end(), 1) == gaps.end())
    return;
  level_.assign(gaps.size(), Level::far);
  const auto around = [&](const auto& is_centre, Level level)
  {
    VoxelPlace place{};
    for (place[2] = 0; place[2] < grid_.size[2]; ++place[2])
      for (place[1] = 0; place[1] < grid_.size[1]; ++place[1])
        for (place[0] = 0; place[0] < grid_.size[0]; ++place[0])
          if (is_centre(cell(place)))
          {
            level_[cell(place)] = Level::at_gap;
            each_neighbour(place, false,
                           [&](const VoxelPlace& other)
                           {
                             for (int a = 0; a < 3; ++a)
                               if (other[a] < 0 || other[a] >= grid_.size[a])
                                 return;
                             if (level_[cell(other)] == Level::far)
                               level_[cell(other)] = level;
                           });
          }
  };
  around([&](std::size_t c) { return gaps[c] != 0; }, Level::at_gap);
  const std::vector<Level> found = level_;
  around([&](std::size_t c) { return found[c] == Level::at_gap; }, Level::beside);
  tissue_of_.assign(gaps.size(), -1);
  for (std::size_t e = 0; e < voxels.place.size(); ++e)
    if (level(voxels.place[e]) != Level::far)
    {
      tissue_of_[cell(voxels.place[e])] = static_cast<std::int32_t>(tissue_.size());
      tissue_.emplace_back();
      tissue_.back().voxel = static_cast<std::uint32_t>(e);
    }
}

void Gaps::find_points(Tissue& tissue, const VoxelPlace& place) const
{
  const int per_edge = std::max(samples_, points_per_edge);
  BlockClassifier classifier(volumes_, grid_, per_edge, 0, none_);
  const std::vector<char> is_tissue = classifier.tissue_samples(place);
  const Vector3d corner = grid_.corner(place);
  const Vector3d centre = corner + 0.5 * grid_.spacing;
  tissue.pieces = walls_->pieces_in(Box(corner - reach * grid_.spacing, corner + (1 + reach) * grid_.spacing));
  const std::uint64_t at_centre = walls_->enclosing(centre);
  for (std::size_t s = 0; s < is_tissue.size(); ++s)
  {
    if (is_tissue[s] == 0)
      continue;
    const Vector3d p = spread_point(Box(corner, corner + grid_.spacing), static_cast<int>(s) - 1);
    tissue.points.push_back(p);
    tissue.sample.push_back(static_cast<int>(s));
    tissue.enclosing.push_back(walls_->enclosing(p, centre, at_centre, tissue.pieces));
  }
  tissue.part.assign(tissue.points.size(), 0);
}

void Gaps::find_parts(Tissue& tissue) const
{
  const std::size_t count = tissue.points.size();
  const double near = reach * grid_.spacing.maxCoeff();
  Sets sets(count);
  std::size_t cut = 0;
  std::vector<std::pair<std::size_t, std::size_t>> beyond;
  for (std::size_t i = 1; i < count; ++i)
    for (std::size_t j = 0; j < i; ++j)
      if ((tissue.points[i] - tissue.points[j]).squaredNorm() < near * near && sets.find_set(i) != sets.find_set(j))
        switch (walls_->way_out(tissue.points[i], tissue.enclosing[i], tissue.points[j], tissue.pieces))
        {
          case Way::and_in:
            ++cut;
            break;
          case Way::beyond:
            beyond.emplace_back(i, j);
            break;
          default:
            sets.union_set(i, j);
        }
  if (mostly_beyond(beyond.size(), cut))
    for (const auto& [i, j] : beyond)
      sets.union_set(i, j);
  // The parts are sorted by the number of samples in them, the largest number first. Points after the first `all` are
  // not samples.
  const int all = samples_ * samples_ * samples_;
  std::map<std::size_t, int> samples_in;
  for (std::size_t i = 0; i < count; ++i)
    samples_in[sets.find_set(i)] += tissue.sample[i] < all ? 1 : 0;
  std::vector<std::pair<int, std::size_t>> parts;
  parts.reserve(samples_in.size());
  for (const auto& [set, samples] : samples_in)
    parts.emplace_back(-samples, set);
  std::sort(parts.begin(), parts.end());
  // The largest set is a part, however small it is. Points of other sets that are too small to be parts join nothing:
  // they may lie on the other side of a gap.
  const auto is_small = [&](const auto& part)
  { return -part.first < std::max(1.0, scene_.accuracy.fill_min * static_cast<double>(all)); };
  if (!parts.empty())
    parts.erase(std::find_if(parts.begin() + 1, parts.end(), is_small), parts.end());
  for (std::size_t i = 0; i < count; ++i)
  {
    const std::size_t set = sets.find_set(i);
    const auto found = std::find_if(parts.begin(), parts.end(), [&](const auto& part) { return part.second == set; });
    tissue.part[i] = found == parts.end() ? -1 : static_cast<int>(found - parts.begin());
  }
}

/// Finds which parts of a voxel are joined to which parts of a later neighbour.
void Gaps::join_to(Tissue& tissue, const Tissue& other) const
{
  const auto box_of = [&](const Tissue& of)
  {
    const Vector3d corner = grid_.corner(place_[of.voxel]);
    return Box(corner, corner + grid_.spacing);
  };
  const double near = reach * grid_.spacing.maxCoeff();
  const auto points_near = [&](const Tissue& of, const Box& box)
  {
    std::vector<std::size_t> list;
    for (std::size_t i = 0; i < of.points.size(); ++i)
      if (of.part[i] >= 0 && box.squaredExteriorDistance(of.points[i]) < 0.6 * near * near)
        list.push_back(i);
    return list;
  };
  const std::vector<std::size_t> from = points_near(tissue, box_of(other)), to = points_near(other, box_of(tissue));
  std::size_t cut = 0, beyond = 0;
  const auto join = [&](std::size_t i, std::size_t j, const std::vector<GapWalls::Piece>& pieces)
  {
    const std::uint64_t pair = pair_of(tissue.copies[tissue.part[i]], other.copies[other.part[j]]);
    if (std::find(tissue.joined.begin(), tissue.joined.end(), pair) != tissue.joined.end())
      return;
    const Way way = walls_->way_out(tissue.points[i], tissue.enclosing[i], other.points[j], pieces);
    if (way == Way::inside || way == Way::out)
      tissue.joined.push_back(pair);
    cut += way == Way::and_in ? 1 : 0;
    beyond += way == Way::beyond ? 1 : 0;
  };
  bool any = false;
  for (const std::size_t i : from)
    for (const std::size_t j : to)
      if ((tissue.points[i] - other.points[j]).squaredNorm() < near * near)
      {
        any = true;
        join(i, j, tissue.pieces);
      }
  // If the voxels have so little tissue that no two points are close to each other, the nearest two are tested.
  double best = std::numeric_limits<double>::max();
  std::pair<std::size_t, std::size_t> nearest;
  for (std::size_t i = 0; !any && i < tissue.points.size(); ++i)
    for (std::size_t j = 0; j < other.points.size(); ++j)
      if (const double squared = (tissue.points[i] - other.points[j]).squaredNorm();
          squared < best && tissue.part[i] >= 0 && other.part[j] >= 0)
      {
        best = squared;
        nearest = { i, j };
      }
  if (best < std::numeric_limits<double>::max())
    join(nearest.first, nearest.second,
         walls_->pieces_in(Box(tissue.points[nearest.first]).extend(other.points[nearest.second])));
  if (tissue.copies.size() == 1 && other.copies.size() == 1 && mostly_beyond(beyond, cut))
    tissue.joined.push_back(pair_of(tissue.copies[0], other.copies[0]));
}

std::size_t Gaps::add_copies(Voxels& voxels)
{
  BlockClassifier classifier(volumes_, grid_, samples_, 0, none_);
  const auto first = static_cast<std::uint32_t>(voxels.place.size());
  auto next = first;
  std::size_t parted = 0;
  for (Tissue& tissue : tissue_)
  {
    const int parts = tissue.part.empty() ? 1 : 1 + *std::max_element(tissue.part.begin(), tissue.part.end());
    if (parts < 2)
    {
      tissue.copies = { tissue.voxel };
      continue;
    }
    ++parted;
    voxels.flap[tissue.voxel] = -1;
    for (int part = 0; part < parts; ++part)
    {
      std::vector<char> chosen(std::size_t{ 1 } * samples_ * samples_ * samples_, 0);
      for (std::size_t i = 0; i < tissue.part.size(); ++i)
        if (static_cast<std::size_t>(tissue.sample[i]) < chosen.size())
          chosen[tissue.sample[i]] = tissue.part[i] == part || (tissue.part[i] < 0 && part == 0) ? 1 : 0;
      classifier.add_part(voxels.place[tissue.voxel], chosen);
      tissue.copies.push_back(next++);
    }
  }
  voxels.append(classifier.take());
  voxels.flap.resize(voxels.place.size(), 0);
  return parted;
}

void Gaps::part(Voxels& voxels, BakeMonitor& monitor)
{
  mark(voxels, monitor);
  if (tissue_.empty())
    return;
  voxels.flap.assign(voxels.place.size(), 0);
  parallel_for(monitor, tissue_.size(), 16,
               [&](std::size_t t)
               {
                 const VoxelPlace& place = voxels.place[tissue_[t].voxel];
                 find_points(tissue_[t], place);
                 if (level(place) == Level::at_gap)
                   find_parts(tissue_[t]);
               });
  const std::size_t parted = add_copies(voxels);
  place_ = voxels.place;
  parallel_for(monitor, tissue_.size(), 16,
               [&](std::size_t t)
               {
                 const VoxelPlace& place = place_[tissue_[t].voxel];
                 each_neighbour(place, true,
                                [&](const VoxelPlace& at)
                                {
                                  const Tissue* const other = tissue_at(at);
                                  if (other != nullptr && (level(place) == Level::at_gap || level(at) == Level::at_gap))
                                    join_to(tissue_[t], *other);
                                });
               });
  assign_flaps(voxels);
  flap_ = voxels.flap;
  const auto moved = std::count_if(flap_.begin(), flap_.end(), [](std::int8_t flap) { return flap > 0; });
  if (moved == 0)
    voxels.flap.clear();
  else
    monitor.found(
        "gaps: {} voxels hold tissue of several sides and are parted; {} voxels lie in {} flaps, joined at {} "
        "nodes",
        parted, moved, static_cast<int>(*std::max_element(flap_.begin(), flap_.end())), voxels.joints.size());
}

VoxelPlace Gaps::place_of(const Vector3d& p) const
{
  const Vector3d at = (p - grid_.lower).cwiseQuotient(grid_.spacing).array().floor();
  VoxelPlace place{};
  for (int a = 0; a < 3; ++a)
    place[a] = static_cast<std::int32_t>(std::clamp(at[a], -1.0, 1e9));
  return place;
}

bool Gaps::extends_to(const Vector3d& centre, int flap, const Vector3d& point) const
{
  const VoxelPlace place = place_of(centre);
  const Tissue* const tissue = tissue_at(place);
  if (tissue == nullptr || level(place) != Level::at_gap)
    return true;
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t i = 0; i < tissue->points.size(); ++i)
    if (tissue->part[i] >= 0 && flap_[tissue->copies[tissue->part[i]]] == flap)
      near.emplace_back((tissue->points[i] - point).squaredNorm(), i);
  constexpr std::size_t most_looks = 8;
  const auto looks = static_cast<std::ptrdiff_t>(std::min(near.size(), most_looks));
  std::partial_sort(near.begin(), near.begin() + looks, near.end());
  // The surface of a bone and the limit of the tissue may be a little apart.
  const double tolerance = 0.1 * grid_.spacing.minCoeff();
  return std::any_of(near.begin(), near.begin() + looks,
                     [&](const auto& entry)
                     {
                       const Vector3d& x = tissue->points[entry.second];
                       const double length = std::sqrt(entry.first);
                       const Vector3d end = x + std::max(0.0, 1 - tolerance / length) * (point - x);
                       return walls_->way_out(x, tissue->enclosing[entry.second], end,
                                              walls_->pieces_in(Box(x).extend(end))) == Way::inside;
                     });
}

std::optional<Gaps::Owner> Gaps::owner(const Vector3d& p, const Vector3d& inside) const
{
  const VoxelPlace middle = place_of(p);
  if (level(middle) != Level::at_gap)
    return std::nullopt;
  struct Found
  {
    double squared;
    const Tissue* tissue;
    std::size_t point;
  };
  std::vector<Found> found;
  const auto add = [&](const VoxelPlace& place)
  {
    const Tissue* const tissue = tissue_at(place);
    for (std::size_t i = 0; tissue != nullptr && i < tissue->points.size(); ++i)
      if (tissue->part[i] >= 0)
        found.push_back({ (tissue->points[i] - p).squaredNorm(), tissue, i });
  };
  add(middle);
  each_neighbour(middle, false, add);
  if (found.empty())
    return std::nullopt;
  constexpr std::size_t most_looks = 24;
  const std::size_t looks = std::min(found.size(), most_looks);
  std::partial_sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(looks), found.end(),
                    [](const Found& a, const Found& b) { return a.squared < b.squared; });
  const auto sees = [&](const Found& f)
  {
    const Vector3d& x = f.tissue->points[f.point];
    const Way way = walls_->way_out(x, f.tissue->enclosing[f.point], inside, walls_->pieces_in(Box(x).extend(inside)));
    return way == Way::inside || way == Way::out;
  };
  const auto end = found.begin() + static_cast<std::ptrdiff_t>(looks);
  const auto seen = std::find_if(found.begin(), end, sees);
  const Found& best = seen == end ? found.front() : *seen;
  const std::uint32_t voxel = best.tissue->copies[best.tissue->part[best.point]];
  return Owner{ grid_.corner(place_[voxel]) + 0.5 * grid_.spacing, flap_[voxel] };
}

}  // namespace frontalis
