#include "bake/fibres/muscle_volumes.hpp"

#include "bake/parallel.hpp"
#include "bake/voxels/volume_probe.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

constexpr double points_a_muscle = 10000;

struct Interval
{
  double from = 0, to = 0;
};

/// Adds the parts of a line along x at (y, z) that a mesh winds around once or more.
void add_intervals(const TriangleTree& tree, const Box& box, double y, double z, double step,
                   std::vector<Interval>& intervals)
{
  std::vector<std::int32_t> near;
  Box line;
  const double margin = 0.01 * step;
  line.include(Vector3{ box.lower[0] - margin, y - margin, z - margin });
  line.include(Vector3{ box.upper[0] + margin, y + margin, z + margin });
  tree.gather(line, near);

  // crossings by place, +1 inwards and -1 outwards
  std::vector<std::pair<double, int>> crossings;
  const TriangleMesh& mesh = tree.mesh();
  for (const std::int32_t t : near)
  {
    std::array<Vector3, 3> v{};
    for (std::size_t c = 0; c < 3; ++c)
      v[c] = mesh.vertices[static_cast<std::size_t>(mesh.triangles[static_cast<std::size_t>(t)][c])];
    std::array<double, 3> area{};
    for (std::size_t c = 0; c < 3; ++c)
    {
      const Vector3 &p = v[(c + 1) % 3], &q = v[(c + 2) % 3];
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

/// Parts that several bodies cover count once.
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

/// Where a point of a muscle stands: in the tissue and the muscle's limits, or what clips it.
Standing muscle_standing(const Volumes& volumes, const Volumes::Entry& muscle, const Vector3& p)
{
  Standing best = Standing::cropped;
  for (const Volumes::Entry& entry : volumes.entries())
  {
    if (!entry.volume->tissue)
      continue;
    const Standing here = standing(volumes, entry, p);
    if (here == Standing::inside)
    {
      const Standing own = standing(volumes, muscle, p);
      return own == Standing::inside ? own : (own == Standing::excluded ? own : Standing::too_deep);
    }
    best = here;
  }
  return best;
}

void measure(const Volumes& volumes, const Volumes::Entry& entry, BakeReport::MuscleVolume& muscle)
{
  Box box;
  double size = 0;
  for (const int s : entry.inside)
  {
    const PreparedSurface& surface = *volumes.solids()[static_cast<std::size_t>(s)].surface;
    box.include(surface.box());
    size += std::abs(signed_volume(surface.mesh()));
  }
  const double step = std::cbrt(size / points_a_muscle);
  std::vector<Interval> intervals;
  for (double y = box.lower[1] + 0.4971 * step; y < box.upper[1]; y += step)
  {
    for (double z = box.lower[2] + 0.5013 * step; z < box.upper[2]; z += step)
    {
      intervals.clear();
      for (const int s : entry.inside)
        add_intervals(volumes.solids()[static_cast<std::size_t>(s)].surface->tree(), box, y, z, step, intervals);
      unite(intervals);
      for (const Interval& interval : intervals)
      {
        const double length = interval.to - interval.from;
        const double parts = std::max(1.0, std::round(length / step));
        const double part = length / parts * step * step;
        for (double i = 0.5; i < parts; ++i)
        {
          const Standing here = muscle_standing(volumes, entry, { interval.from + i / parts * length, y, z });
          muscle.mesh += part;
          (here == Standing::inside     ? muscle.in_tissue
           : here == Standing::excluded ? muscle.in_bone
           : here == Standing::beyond   ? muscle.beyond_skin
                                        : muscle.elsewhere) += part;
        }
      }
    }
  }
}

}  // namespace

std::vector<BakeReport::MuscleVolume> measure_muscles(const Volumes& volumes, const Model& model, BakeStages& stages)
{
  std::vector<BakeReport::MuscleVolume> muscles(model.muscles.size());
  const double voxel_volume = model.spacing[0] * model.spacing[1] * model.spacing[2];
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    for (auto m = static_cast<std::size_t>(model.fibre_begin[e]);
         m < static_cast<std::size_t>(model.fibre_begin[e + 1]); ++m)
      muscles[static_cast<std::size_t>(model.fibre_muscle[m])].voxels +=
          static_cast<double>(model.fill[e]) * static_cast<double>(model.fibre_weight[m]) * voxel_volume;
  }
  std::vector<const Volumes::Entry*> made_of_surfaces(muscles.size(), nullptr);
  for (const Volumes::Entry& entry : volumes.entries())
  {
    if (entry.muscle >= 0 && !entry.inside.empty())
      made_of_surfaces[static_cast<std::size_t>(entry.muscle)] = &entry;
  }
  parallel_for(
      muscles.size(),
      [&](std::size_t m)
      {
        muscles[m].name = model.muscles[m].name;
        if (made_of_surfaces[m] != nullptr)
          measure(volumes, *made_of_surfaces[m], muscles[m]);
      },
      &stages);
  std::size_t kept = 0;
  for (std::size_t m = 0; m < muscles.size(); ++m)
  {
    if (made_of_surfaces[m] != nullptr)
      muscles[kept++] = muscles[m];
  }
  muscles.resize(kept);
  return muscles;
}

}  // namespace frontalis
