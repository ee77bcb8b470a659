#include "bake/fibres/fibres.hpp"
#include "bake/voxels/model_stages.hpp"

namespace frontalis
{
namespace
{

constexpr double points_per_muscle = 10000;  // approximate number of points of integration

/// Appends the coordinates x [m] at which the line along x through (y, z) enters (+1) or leaves (-1) a mesh.
void add_crossings(const TriangleTree& tree, const Box& box, double y, double z, double step,
                   std::vector<std::pair<double, int>>& crossings)
{
  std::vector<std::int32_t> near;
  const Vector3d margin = Vector3d::Constant(0.01 * step);
  tree.gather(Box(Vector3d(box.min()[0], y, z) - margin, Vector3d(box.max()[0], y, z) + margin), near);
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
}

/// Tells whether a point of a muscle lies in the tissue and within the muscle's limits, or which condition fails.
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
  const auto add_points = [&](double from, double to, double y, double z)
  {
    const double length = to - from;
    const double parts = std::max(1.0, std::round(length / step));
    const double part = length / parts * step * step;
    for (double i = 0.5; i < parts; ++i)
    {
      const Membership here = in_tissue(volumes, entry, { from + i / parts * length, y, z });
      muscle.mesh += part;
      (here == Membership::inside     ? muscle.in_tissue
       : here == Membership::excluded ? muscle.in_bone
       : here == Membership::beyond   ? muscle.beyond_skin
                                      : muscle.elsewhere) += part;
    }
  };
  std::vector<std::pair<double, int>> crossings;
  for (double y = box.min()[1] + 0.4971 * step; y < box.max()[1]; y += step)
    for (double z = box.min()[2] + 0.5013 * step; z < box.max()[2]; z += step)
    {
      crossings.clear();
      for (const std::size_t b : entry.inside)
        add_crossings(volumes.body(b).tree(), box, y, z, step, crossings);
      std::sort(crossings.begin(), crossings.end());
      // Overlapping bodies count once: from the entry into the first of them to the exit from the last.
      double from = 0;
      int bodies = 0;
      for (const auto& [x, change] : crossings)
      {
        const int before = bodies;
        bodies += change;
        if (before <= 0 && bodies > 0)
          from = x;
        else if (before > 0 && bodies <= 0)
          add_points(from, x, y, z);
      }
    }
}

}  // namespace

std::vector<BakeReport::MuscleVolume> measure_muscles(const Volumes& volumes, const std::vector<MuscleFibres>& fibres,
                                                      const Model& model, BakeMonitor& monitor)
{
  std::vector<BakeReport::MuscleVolume> muscles(fibres.size());
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
                 muscles[m].nurbs = fibres[m].fitted_size;
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
