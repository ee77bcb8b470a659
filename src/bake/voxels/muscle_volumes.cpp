#include "bake/voxels/muscle_volumes.hpp"

#include "bake/parallel.hpp"
#include "bake/voxels/volume_probe.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

constexpr double points_per_muscle = 10000;

struct Interval
{
  double from = 0, to = 0;
};

/// Adds the parts of the line along x through (y, z) that lie inside a mesh: where its winding number is above 0.
void add_intervals(const TriangleTree& tree, const Box& box, double y, double z, double step,
                   std::vector<Interval>& intervals)
{
  std::vector<std::int32_t> near;
  const Vector3d margin = Vector3d::Constant(0.01 * step);
  tree.gather(Box(Vector3d(box.min()[0], y, z) - margin, Vector3d(box.max()[0], y, z) + margin), near);

  // crossings by their x: +1 into the mesh, -1 out of it
  std::vector<std::pair<double, int>> crossings;
  for (const std::int32_t t : near)
  {
    const auto v = corners(tree.mesh(), tree.mesh().triangles[t]);
    std::array<double, 3> area{};
    for (std::size_t c = 0; c < 3; ++c)
    {
      const Vector3d &p = v[(c + 1) % 3], &q = v[(c + 2) % 3];
      area[c] = (p[1] - y) * (q[2] - z) - (p[2] - z) * (q[1] - y);
    }
    const bool forwards = area[0] > 0 && area[1] > 0 && area[2] > 0;
    const bool backwards = area[0] < 0 && area[1] < 0 && area[2] < 0;
    if (forwards || backwards)
      crossings.emplace_back(
          (area[0] * v[0][0] + area[1] * v[1][0] + area[2] * v[2][0]) / (area[0] + area[1] + area[2]),
          forwards ? -1 : 1);
  }
  std::sort(crossings.begin(), crossings.end());
  int winding = 0;
  for (std::size_t c = 0; c + 1 < crossings.size(); ++c)
  {
    winding += crossings[c].second;
    if (winding > 0)
      intervals.push_back({ crossings[c].first, crossings[c + 1].first });
  }
}

/// Joins intervals that overlap, so that what lies in several bodies counts once.
void unite(std::vector<Interval>& intervals)
{
  std::sort(intervals.begin(), intervals.end(), [](const Interval& a, const Interval& b) { return a.from < b.from; });
  std::size_t kept = 0;
  for (const Interval interval : intervals)
  {
    if (kept > 0 && interval.from <= intervals[kept - 1].to)
      intervals[kept - 1].to = std::max(intervals[kept - 1].to, interval.to);
    else
      intervals[kept++] = interval;
  }
  intervals.resize(kept);
}

/// Whether a point of a muscle lies in the tissue and within the muscle's limits, or which condition fails.
Membership in_tissue(const Volumes& volumes, const Volumes::Entry& muscle, const Vector3d& p)
{
  Membership best = Membership::cropped;
  for (const Volumes::Entry& entry : volumes.entries())
  {
    if (!entry.volume->tissue)
      continue;
    best = membership(volumes, entry, p);
    if (best != Membership::inside)
      continue;
    const Membership own = membership(volumes, muscle, p);
    return own == Membership::inside || own == Membership::excluded ? own : Membership::wrong_depth;
  }
  return best;
}

void measure(const Volumes& volumes, const Volumes::Entry& entry, BakeReport::MuscleVolume& muscle)
{
  Box box;
  double size = 0;
  for (const std::size_t b : entry.inside)
  {
    box.extend(volumes.body(b).box());
    size += std::abs(signed_volume(volumes.body(b).mesh()));
  }
  const double step = std::cbrt(size / points_per_muscle);
  std::vector<Interval> intervals;
  for (double y = box.min()[1] + 0.4971 * step; y < box.max()[1]; y += step)
    for (double z = box.min()[2] + 0.5013 * step; z < box.max()[2]; z += step)
    {
      intervals.clear();
      for (const std::size_t b : entry.inside)
        add_intervals(volumes.body(b).tree(), box, y, z, step, intervals);
      unite(intervals);
      for (const Interval& interval : intervals)
      {
        const double length = interval.to - interval.from;
        const double parts = std::max(1.0, std::round(length / step));
        const double part = length / parts * step * step;
        for (double i = 0.5; i < parts; ++i)
        {
          const Membership here = in_tissue(volumes, entry, { interval.from + i / parts * length, y, z });
          muscle.mesh += part;
          (here == Membership::inside     ? muscle.in_tissue
           : here == Membership::excluded ? muscle.in_bone
           : here == Membership::beyond   ? muscle.beyond_skin
                                          : muscle.elsewhere) += part;
        }
      }
    }
}

}  // namespace

std::vector<BakeReport::MuscleVolume> measure_muscles(const Volumes& volumes, const Model& model, BakeMonitor& monitor)
{
  std::vector<BakeReport::MuscleVolume> muscles(model.muscles.size());
  const double voxel_volume = model.spacing[0] * model.spacing[1] * model.spacing[2];
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
    for (std::int32_t m = model.fibre_begin[e]; m < model.fibre_begin[e + 1]; ++m)
      muscles[model.fibre_muscle[m]].voxels +=
          static_cast<double>(model.fill[e]) * static_cast<double>(model.fibre_weight[m]) * voxel_volume;
  std::vector<const Volumes::Entry*> made_of_surfaces(muscles.size(), nullptr);
  for (const Volumes::Entry& entry : volumes.entries())
    if (entry.muscle >= 0 && !entry.inside.empty())
      made_of_surfaces[entry.muscle] = &entry;
  parallel_for(monitor, muscles.size(), 1,
               [&](std::size_t m)
               {
                 muscles[m].name = model.muscles[m].name;
                 if (made_of_surfaces[m] != nullptr)
                   measure(volumes, *made_of_surfaces[m], muscles[m]);
               });
  std::size_t kept = 0;
  for (std::size_t m = 0; m < muscles.size(); ++m)
    if (made_of_surfaces[m] != nullptr)
      muscles[kept++] = muscles[m];
  muscles.resize(kept);
  return muscles;
}

}  // namespace frontalis
