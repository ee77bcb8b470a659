#include "bake/fibres/fibres.hpp"

#include "bake/messages.hpp"

namespace frontalis
{
void scale_strength(const Scene& scene, const std::vector<MuscleFibres>& fibres, const LocalFrame& frame, Model& model,
                    BakeMonitor& monitor, BakeReport* report)
{
  constexpr double thinnest = 0.1;  // share of its cross-section in people below which a muscle is probably damaged
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
    force.given = scene.muscles[m].cross_section;
    const bool pulls = extents[m].volume > 0;
    if (pulls)
    {
      force.length = fibres[m].volume ? fibres[m].volume->fibre_length() : extents[m].last - extents[m].first + edge;
      force.cross_section = extents[m].volume / force.length;
    }
    if (pulls && force.given > 0)
      muscle.stress_reference *= force.given / force.cross_section;
    if (!pulls && !scene.switched_off.has(Effect::contraction))
      monitor.warn(
          "{} has no voxel in the model, so that it does not pull: check the thickness and place of its surface",
          place_in_scene(scene, "muscle", scene.muscles[m]));
    else if (force.cross_section < thinnest * force.given)
      monitor.warn(
          "{} has {:.2g} mm2 of its cross-section of {:.3g} mm2 in the model, so that its stress is {:.0f} times its "
          "'stress_reference': check the thickness of its surface, and how much of it lies in the tissue",
          place_in_scene(scene, "muscle", scene.muscles[m]), 1e6 * force.cross_section, 1e6 * force.given,
          force.given / force.cross_section);
    force.force = muscle.stress_reference * force.cross_section;
    if (report != nullptr)
      report->forces.push_back(force);
  }
}

}  // namespace frontalis
