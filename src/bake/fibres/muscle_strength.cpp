#include "bake/fibres/fibres.hpp"

namespace frontalis
{
namespace
{

/// Mean length of the fibres of a NURBS volume [m], from 3 x 3 fibres of 32 chords each.
double mean_length(const NurbsVolume& volume)
{
  constexpr int chords = 32;
  double sum = 0;
  for (int fibre = 0; fibre < 9; ++fibre)
  {
    const int column = fibre % 3, row = fibre / 3;
    const double v = (0.5 + column) / 3, w = (0.5 + row) / 3;
    Vector3d before = volume.at({ 0, v, w }).position;
    for (int c = 1; c <= chords; ++c)
    {
      const Vector3d here = volume.at({ static_cast<double>(c) / chords, v, w }).position;
      sum += (here - before).norm();
      before = here;
    }
  }
  return sum / 9;
}

}  // namespace

void scale_strength(const Scene& scene, const std::vector<MuscleFibres>& fibres, const LocalFrame& frame, Model& model,
                    BakeReport* report)
{
  struct Extent
  {
    double volume = 0, first = 1e300, last = -1e300;
  };
  std::vector<Extent> extents(model.muscles.size());
  const double voxel = model.spacing[0] * model.spacing[1] * model.spacing[2];
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
    for (std::int32_t f = model.fibre_begin[e]; f < model.fibre_begin[e + 1]; ++f)
    {
      const std::int16_t m = model.fibre_muscle[f];
      Extent& extent = extents[m];
      extent.volume += static_cast<double>(model.fill[e]) * static_cast<double>(model.fibre_weight[f]) * voxel;
      if (fibres[m].volume)
        continue;
      extent.first = std::min(extent.first, fibres[m].along(frame.voxel_centre(model, e)));
      extent.last = std::max(extent.last, fibres[m].along(frame.voxel_centre(model, e)));
    }
  const double edge = *std::max_element(model.spacing.begin(), model.spacing.end());
  for (std::size_t m = 0; m < fibres.size(); ++m)
  {
    Muscle& muscle = model.muscles[m];
    BakeReport::MuscleForce force;
    force.name = muscle.name;
    force.length = fibres[m].volume ? mean_length(*fibres[m].volume) : extents[m].last - extents[m].first + edge;
    force.cross_section = extents[m].volume / force.length;
    force.given = scene.muscles[m].cross_section;
    if (force.given > 0 && force.cross_section > 0)
      muscle.stress_reference *= force.given / force.cross_section;
    force.force = muscle.stress_reference * force.cross_section;
    if (report != nullptr)
      report->forces.push_back(force);
  }
}

}  // namespace frontalis
