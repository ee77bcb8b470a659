#include "bake/fibres/fibres.hpp"

namespace frontalis
{
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
    force.length = fibres[m].volume ? fibres[m].volume->fibre_length() : extents[m].last - extents[m].first + edge;
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
