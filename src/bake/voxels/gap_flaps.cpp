#include "bake/voxels/gaps.hpp"

#include "bake/messages.hpp"

#include <boost/pending/disjoint_sets.hpp>

#include <map>
#include <unordered_map>
#include <unordered_set>

namespace frontalis
{
namespace
{

constexpr int most_flaps = 100;

/// A point of the grid and the voxels around it. Voxels of the same group are joined at the point.
struct GridPoint
{
  VoxelPlace at{};
  std::vector<std::uint32_t> voxel;
  std::vector<std::size_t> group;

  bool parted() const
  {
    return std::any_of(group.begin(), group.end(), [&](std::size_t g) { return g != group.front(); });
  }
};

VoxelPlace corner(const VoxelPlace& place, int c)
{
  return { { place[0] + (c & 1), place[1] + (c >> 1 & 1), place[2] + (c >> 2) } };
}

}  // namespace

void Gaps::assign_flaps(Voxels& voxels) const
{
  std::unordered_set<std::uint64_t> joined;
  for (const Tissue& tissue : tissue_)
    joined.insert(tissue.joined.begin(), tissue.joined.end());
  VoxelIndex all(voxels.place, grid_.size);

  // The points of the grid around all tissue at gaps and next to them.
  std::map<VoxelPlace, GridPoint> points;
  for (const Tissue& tissue : tissue_)
    for (int c = 0; c < 8; ++c)
    {
      const VoxelPlace at = corner(place_[tissue.voxel], c);
      points[at].at = at;
    }
  for (auto& [at, point] : points)
  {
    std::vector<bool> at_gap;
    for (int c = 0; c < 8; ++c)
    {
      const VoxelPlace place{ { at[0] - (c & 1), at[1] - (c >> 1 & 1), at[2] - (c >> 2) } };
      if (const Tissue* const tissue = tissue_at(place); tissue != nullptr)
        for (const std::uint32_t voxel : tissue->copies)
        {
          point.voxel.push_back(voxel);
          at_gap.push_back(level(place) == Level::at_gap);
        }
      else if (const std::int32_t voxel = all.find(place); voxel >= 0)
      {
        point.voxel.push_back(static_cast<std::uint32_t>(voxel));
        at_gap.push_back(false);
      }
    }
    boost::disjoint_sets_with_storage<> sets(point.voxel.size());
    for (std::size_t a = 0; a < point.voxel.size(); ++a)
      for (std::size_t b = 0; b < a; ++b)
      {
        const std::uint64_t low = std::min(point.voxel[a], point.voxel[b]),
                            high = std::max(point.voxel[a], point.voxel[b]);
        if ((!at_gap[a] && !at_gap[b]) || joined.count(low << 32 | high) > 0)
          sets.union_set(a, b);
      }
    for (std::size_t a = 0; a < point.voxel.size(); ++a)
      point.group.push_back(sets.find_set(a));
  }

  // Voxels at points with several groups, and copies of voxels, need flaps. Voxels that are joined get the same flap.
  std::map<std::uint32_t, std::vector<const GridPoint*>> points_of;
  for (const auto& [at, point] : points)
    if (point.parted())
      for (const std::uint32_t voxel : point.voxel)
        points_of[voxel].push_back(&point);
  for (const Tissue& tissue : tissue_)
    for (const std::uint32_t voxel : tissue.copies)
      if (tissue.copies.size() > 1)
        points_of[voxel];
  std::vector<std::uint32_t> voxel_of;
  std::unordered_map<std::uint32_t, std::size_t> number;
  for (const auto& entry : points_of)
  {
    number[entry.first] = voxel_of.size();
    voxel_of.push_back(entry.first);
  }
  boost::disjoint_sets_with_storage<> sets(voxel_of.size());
  for (const auto& entry : points_of)
    for (const GridPoint* const point : entry.second)
      for (std::size_t a = 0; a < point->voxel.size(); ++a)
        for (std::size_t b = 0; b < a; ++b)
          if (point->group[a] == point->group[b])
            sets.union_set(number[point->voxel[a]], number[point->voxel[b]]);
  std::map<std::size_t, std::vector<std::uint32_t>> members;
  for (std::size_t n = 0; n < voxel_of.size(); ++n)
    members[sets.find_set(n)].push_back(voxel_of[n]);
  std::vector<std::vector<std::uint32_t>> order;
  order.reserve(members.size());
  for (auto& entry : members)
    order.push_back(std::move(entry.second));
  std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });

  std::vector<std::int8_t>& flap = voxels.flap;
  for (const std::uint32_t voxel : voxel_of)
    flap[voxel] = -1;
  std::map<VoxelPlace, std::vector<std::uint32_t>> copies_at;
  for (const std::uint32_t voxel : voxel_of)
    copies_at[voxels.place[voxel]].push_back(voxel);
  const auto fits = [&](std::uint32_t voxel, int f)
  {
    for (const std::uint32_t other : copies_at[voxels.place[voxel]])
      if (other != voxel && flap[other] == f)
        return false;
    for (const GridPoint* const point : points_of[voxel])
    {
      const auto own = std::find(point->voxel.begin(), point->voxel.end(), voxel) - point->voxel.begin();
      for (std::size_t a = 0; a < point->voxel.size(); ++a)
        if (flap[point->voxel[a]] == f && point->group[a] != point->group[own])
          return false;
    }
    return true;
  };
  const auto put = [&](const std::vector<std::uint32_t>& list, int f)
  {
    for (std::size_t n = 0; n < list.size(); ++n)
    {
      if (fits(list[n], f))
      {
        flap[list[n]] = static_cast<std::int8_t>(f);
        continue;
      }
      while (n-- > 0)
        flap[list[n]] = -1;
      return false;
    }
    return true;
  };
  for (const auto& list : order)
  {
    int f = 0;
    while (f < 4 && !put(list, f))
      ++f;
    if (f < 4)
      continue;
    // These joined voxels surround the end of a gap and do not fit into one flap. A flap is chosen for each separately.
    for (const std::uint32_t voxel : list)
    {
      for (f = 0; f < most_flaps && !put({ voxel }, f); ++f)
      {
      }
      if (f == most_flaps)
        throw failure("{}: gaps: more than {} sides of gaps meet in a voxel", scene_.file, most_flaps);
    }
  }

  // Joins a voxel in a flap, at each of its corners, to the voxel of its group in the lowest flap.
  for (const auto& [at, point] : points)
    for (std::size_t b = 0; b < point.voxel.size(); ++b)
    {
      std::size_t lowest = b;
      for (std::size_t a = 0; a < point.voxel.size(); ++a)
        if (point.group[a] == point.group[b] && flap[point.voxel[a]] < flap[point.voxel[lowest]])
          lowest = a;
      if (lowest != b)
        voxels.joints.push_back({ point.voxel[lowest], point.voxel[b], at });
    }
}

}  // namespace frontalis
