#include "frontalis/bake/bake.hpp"

#include "bake/voxels/bind_points.hpp"
#include "bake/fibres/fibres.hpp"
#include "bake/fibres/fibre_families.hpp"
#include "frontalis/error.hpp"
#include "frontalis/model/effects.hpp"
#include "bake/length_text.hpp"
#include "bake/voxels/local_frame.hpp"
#include "bake/fibres/muscle_volumes.hpp"
#include "bake/voxels/restricted_nodes.hpp"
#include "bake/voxels/spread_points.hpp"
#include "bake/mesh/surface.hpp"
#include "bake/voxels/volume_probe.hpp"
#include "bake/voxels/volumes.hpp"
#include "bake/voxels/voxelise.hpp"

#include <cmath>
#include <cstdio>

namespace frontalis
{
namespace
{

/// Refuses volumes without a point in the tissue and says how much of each muscle was clipped.
void check_volumes(const Scene& scene, const Volumes& volumes, const Voxels& voxels, BakeStages& stages)
{
  for (std::size_t v = 0; v < volumes.entries().size(); ++v)
  {
    const Volumes::Entry& entry = volumes.entries()[v];
    const double size = voxels.volume_size.empty() ? 0 : voxels.volume_size[v];
    if (size <= 0)
    {
      if (entry.volume->tissue)
        throw Error(
            volumes.place(*entry.volume) +
            ": is empty: no point is inside its surfaces, outside the others, at its depth and in its crop; check "
            "these, the units and the voxel size");
      const std::string what = entry.muscle >= 0
                                   ? "muscle '" + scene.muscles[static_cast<std::size_t>(entry.muscle)].name +
                                         "' lies wholly outside the tissue"
                                   : "no point of it lies in the tissue";
      throw Error(volumes.place(*entry.volume) + ": " + what +
                  ", or is thinner than the samples can see; check its surfaces, its crop and the voxel size");
    }
    if (entry.muscle < 0 || entry.volume->closed_by.size() > 0 || entry.inside.empty())
      continue;
    double whole = 0;
    bool closed = true;
    for (const int s : entry.inside)
    {
      const PreparedSurface& surface = *volumes.solids()[static_cast<std::size_t>(s)].surface;
      whole += signed_volume(surface.mesh());
      closed = closed && surface.closed();
    }
    char text[256];
    std::snprintf(text, sizeof(text), "muscle '%s': %.4g cm3 in the tissue, %.4g cm3 by its surface (%.0f %% clipped)",
                  scene.muscles[static_cast<std::size_t>(entry.muscle)].name.c_str(), 1e6 * size, 1e6 * whole,
                  100 * std::max(0.0, 1 - size / whole));
    stages.found(closed ? text : std::string(text) + "; the surface is open");
  }
}

/// Greatest depth of a volume's points below a surface, of some thousand points.
double greatest_depth(const Volumes& volumes, const Volumes::Entry& entry, const PreparedSurface& surface)
{
  double greatest = 0;
  for (int i = 0; i < 4000; ++i)
  {
    const Vector3 p = spread_point(volumes.tissue_box(), i);
    if (standing(volumes, entry, p) == Standing::inside)
      greatest = std::max(greatest, -surface.signed_distance(p, surface.tree().closest(p)));
  }
  return greatest;
}

/// Refuses layers below the tissue's end, and such as leave nothing of the material below them.
void check_layers(const Scene& scene, const Volumes& volumes, const Voxels& voxels)
{
  for (std::size_t v = 0; v < volumes.entries().size(); ++v)
  {
    const auto& bands = volumes.entries()[v].bands;
    for (std::size_t b = 0; b <= bands.size() && !bands.empty(); ++b)
    {
      if (voxels.band_size[v][b] > 0)
        continue;
      const Volumes::Band& band = bands[std::min(b, bands.size() - 1)];
      const PreparedSurface& surface = *volumes.depths()[static_cast<std::size_t>(band.depth)].surface;
      const std::string ends = "volume '" + volumes.entries()[v].volume->name + "' ends " +
                               length_text(greatest_depth(volumes, volumes.entries()[v], surface), scene.unit) +
                               " below surface '" + surface.name() + "'";
      throw Error(scene.file + ":" + std::to_string(band.layer->line) + ": layer '" + band.layer->name + "': " +
                  (b < bands.size() ? "begins " + length_text(band.from, scene.unit) + " deep, but " + ends
                                    : "reaches " + length_text(band.to, scene.unit) + " deep and " + ends +
                                          ", so that nothing is left of its own material") +
                  "; thinner layers, or thicker tissue, are wanted");
    }
  }
}

}  // namespace

Model bake(const Scene& scene, BakeReport* report, const BakeProgress& progress)
{
  if (report != nullptr)
  {
    const bool measure = report->measure_muscles;
    *report = {};
    report->measure_muscles = measure;
  }
  BakeStages stages(report, progress);
  if (scene.accuracy.samples < 1 || scene.accuracy.samples > 32)
    throw Error(scene.file + ": accuracy: samples is " + std::to_string(scene.accuracy.samples) +
                "; 1 to 32 are meant");

  stages.begin("surfaces");
  const auto surfaces = prepare_surfaces(scene, stages);
  const Vector3& edges = scene.accuracy.voxel;
  const double sample_spacing = std::min({ edges[0], edges[1], edges[2] }) / scene.accuracy.samples;
  const Volumes volumes(scene, surfaces, sample_spacing);
  check_openings(scene, volumes);
  const Grid grid = make_grid(scene, volumes);

  stages.begin("voxels");
  Model model;
  LocalFrame frame;
  {
    const Voxels voxels = voxelise(volumes, grid, scene.accuracy.samples, scene.accuracy.fill_min, stages);
    check_volumes(scene, volumes, voxels, stages);
    check_layers(scene, volumes, voxels);
    if (voxels.place.empty())
      throw Error(scene.file +
                  ": no voxel has more tissue than fill_min; the tissue is thinner than the voxels: take smaller "
                  "ones, or a smaller fill_min");
    frame = assemble_voxels(grid, voxels, model);
  }
  copy_settings(scene, frame, model);
  build_nodes(model);

  stages.begin("constraints");
  restrict_nodes(scene, surfaces, frame, model, stages);
  remove_islands(model, stages);

  stages.begin("fibres");
  const std::vector<MuscleFibres> fibres = find_fibres(scene, volumes, surfaces, stages);
  add_fibres(scene, fibres, frame, model, stages);

  stages.begin("layers");
  add_thin_layers(volumes, frame, model, stages);

  turn_families(scene, surfaces, frame, model, stages);

  stages.begin("skin");
  bind_surfaces(scene, surfaces, frame, model, stages);

  stages.begin("check");
  switch_off(model, scene.switched_off);
  check_model(model);
  if (report != nullptr && report->measure_muscles)
  {
    stages.begin("muscle volumes");
    report->muscles = measure_muscles(volumes, model, stages);
    for (std::size_t m = 0; m < fibres.size(); ++m)
      report->muscles[m].nurbs = fibres[m].fitted_size;
  }
  stages.finish();
  return model;
}

}  // namespace frontalis
