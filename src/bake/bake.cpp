#include "frontalis/bake/bake.hpp"

#include "bake/checks.hpp"
#include "bake/fibres/fibres.hpp"
#include "bake/messages.hpp"
#include "bake/shapes/head/follow_head.hpp"
#include "bake/voxels/contact_bodies.hpp"
#include "bake/voxels/gaps.hpp"
#include "bake/voxels/self_contacts.hpp"
#include "bake/voxels/shells.hpp"
#include "frontalis/model/effects.hpp"

#include <algorithm>
#include <set>

namespace frontalis
{
namespace
{

constexpr double largest_tissue = 0.6;  // [m]
// Beyond these sizes tissue that would have the size of a face in another unit is an error: its distances from bones,
// at every half millimetre, would take all memory.
constexpr double impossible_tissue[2] = { 1e-3, 0.9 };  // [m]
constexpr std::size_t few_voxels = 100;                 // with fewer, the unit or the voxel is probably wrong

/// Warns of bones that tissue fills: large closed surfaces from files that lie in the tissue and that no volume names.
/// Small ones, such as cartilages, may be meant to hold the tissue in them.
void find_filled_surfaces(const Scene& scene, const PreparedSurfaces& surfaces, const Volumes& volumes,
                          BakeMonitor& monitor)
{
  constexpr int points = 1000;
  constexpr double large = 1e-5;           // [m3]
  constexpr double filled_a_little = 0.1;  // share of the points
  std::set<std::string> named;
  for (const Volume& volume : scene.volumes)
    for (const auto* list : { &volume.closed_by, &volume.inside, &volume.outside, &volume.without, &volume.slits })
      named.insert(list->begin(), list->end());
  for (const Surface& given : scene.surfaces)
  {
    if (given.file.empty() || named.count(given.name) > 0)
      continue;
    const PreparedSurface& surface = named_surface(surfaces, given.name, scene.file);
    if (!surface.closed() || signed_volume(surface.mesh()) < large)
      continue;
    int inside = 0, filled = 0;
    for (int i = 0; i < points; ++i)
      if (const Vector3d p = spread_point(surface.box(), i); surface.tree().winding_number(p) > 0.5)
      {
        ++inside;
        filled += in_tissue(volumes, p) ? 1 : 0;
      }
    if (filled > filled_a_little * inside)
      monitor.warn(
          "{} lies in the tissue, but no volume names it, so that tissue fills {:.0f} % of it; if it is a "
          "bone, add it to 'outside' of the volumes of tissue",
          place_in_scene(scene, "surface", given), 100.0 * filled / inside);
  }
}

/// Warns of tissue that is larger than a head: its length unit is probably wrong. Returns what to say, if the tissue
/// has a size that no face has.
std::string check_size(const Scene& scene, const Volumes& volumes, BakeMonitor& monitor)
{
  const Box tissue = volumes.tissue_box();
  const double extent = tissue.sizes().maxCoeff();
  const bool large = extent > largest_tissue;
  const std::string advice = unit_advice(extent, scene.unit);
  std::string text =
      fmt::format("{}: the tissue spans {}, {} than a {}; check 'unit'{}", scene.file, box_text(tissue, scene.unit),
                  large ? "more" : "less", large ? "head" : "millimetre", advice.empty() ? "" : ": " + advice);
  if (!advice.empty() && (extent < impossible_tissue[0] || extent > impossible_tissue[1]))
    return text;
  if (large)
    monitor.warn("{}", text);
  return {};
}

/// Greatest depth of a volume's points below a surface [m], estimated from 4000 points.
double greatest_depth(const Volumes& volumes, const Volumes::Entry& entry, const PreparedSurface& surface)
{
  const Box box = volumes.tissue_box();
  double greatest = 0;
  for (int i = 0; i < 4000; ++i)
  {
    const Vector3d p = spread_point(box, i);
    if (membership(volumes, entry, p) == Membership::inside)
      greatest = std::max(greatest, -surface.signed_distance(p, surface.tree().closest(p)));
  }
  return greatest;
}

/// Throws Error for layers that begin below the tissue, and for layers that leave no room for the material below them.
void check_layers(const Scene& scene, const Volumes& volumes, const Voxels& voxels)
{
  for (std::size_t v = 0; v < volumes.entries().size(); ++v)
  {
    const Volumes::Entry& entry = volumes.entries()[v];
    for (std::size_t b = 0; b <= entry.bands.size() && !entry.bands.empty(); ++b)
    {
      if (voxels.band_size[v][b] > 0)
        continue;
      const bool in_band = b < entry.bands.size();
      const Volumes::Band& band = in_band ? entry.bands[b] : entry.bands.back();
      const PreparedSurface& surface = *volumes.depth_fields()[band.depth_field].surface;
      const std::string ends =
          fmt::format("volume '{}' ends {} below surface '{}'", entry.volume->name,
                      length_text(greatest_depth(volumes, entry, surface), scene.unit), surface.name());
      const std::string what = in_band
                                   ? fmt::format("begins {} deep, but {}", length_text(band.from, scene.unit), ends)
                                   : fmt::format("reaches {} deep and {}, so that nothing is left of its own material",
                                                 length_text(band.to, scene.unit), ends);
      throw failure("{}: {}; make the layers thinner or the tissue thicker",
                    place_in_scene(scene, "layer", *band.layer), what);
    }
  }
}

}  // namespace

Model bake(const Scene& given, BakeReport* report, const BakeProgress& progress)
{
  const Scene scene = following_head(given);
  const bool measure = report != nullptr && report->measure_muscles;
  if (report != nullptr)
    *report = { {}, {}, {}, {}, measure, {}, {} };
  BakeMonitor monitor(report, progress);
  if (scene.accuracy.samples < 1 || scene.accuracy.samples > 32)
    throw failure("{}: accuracy: samples is {}; it must be 1 to 32", scene.file, scene.accuracy.samples);

  monitor.begin("surfaces");
  const auto surfaces = prepare_surfaces(scene, monitor);
  for (const auto& surface : surfaces)
    if (report != nullptr)
      report->surfaces.push_back({ surface->name(), to_array(surface->box().min()), to_array(surface->box().max()),
                                   surface->mesh().triangles.size(),
                                   surface->closed() ? signed_volume(surface->mesh()) : 0 });
  check_sides(scene, surfaces, monitor);
  const double sample_spacing = to_vector(scene.accuracy.voxel).minCoeff() / scene.accuracy.samples;
  const Volumes volumes(scene, surfaces, sample_spacing);
  check_openings(scene, volumes);
  const std::string impossible = check_size(scene, volumes, monitor);
  const Grid grid = make_grid(scene, volumes);  // its message, if it has one, says more
  if (!impossible.empty())
    throw Error(impossible);
  check_holes(scene, surfaces, volumes, monitor);
  find_surfaces_apart(scene, volumes, monitor);
  find_filled_surfaces(scene, surfaces, volumes, monitor);
  check_places(scene, surfaces, volumes, monitor);

  monitor.begin("voxels");
  Model model;
  LocalFrame frame;
  Gaps gaps(scene, volumes, surfaces, grid);
  {
    Voxels voxels = voxelise(volumes, grid, scene.accuracy.samples, scene.accuracy.fill_min,
                             attaching_surfaces(scene, surfaces), monitor);
    check_volumes(scene, volumes, voxels, monitor);
    check_layers(scene, volumes, voxels);
    if (voxels.place.empty())
      throw Error(scene.file +
                  ": no voxel has more tissue than fill_min; the tissue is thinner than the voxels: use smaller "
                  "voxels or a smaller fill_min");
    if (voxels.place.size() < few_voxels)
      monitor.warn("{}: the tissue has {} only; check 'unit' and 'voxel'", scene.file,
                   count_text(voxels.place.size(), "voxel", "voxels"));
    gaps.part(voxels, monitor);
    if (scene.accuracy.boundary != "true" || scene.accuracy.integration != "one_point")
      voxels.centre.clear();
    frame = assemble_voxels(grid, voxels, model);
    frame.gaps = model.flaps.empty() ? nullptr : &gaps;
  }
  copy_settings(scene, frame, model);
  check_magnitudes(scene, model, monitor);
  check_bone_centres(scene, monitor);

  monitor.begin("fibres");
  const std::vector<MuscleFibres> fibres = find_fibres(scene, volumes, surfaces, monitor);

  monitor.begin("constraints");
  restrict_nodes(scene, surfaces, fibres, frame, model, monitor);
  remove_islands(model, monitor);
  check_moving_bones(scene, model, monitor);
  attach_nodes(scene, surfaces, frame, model, monitor);
  if (model.rigid.empty() && model.sliding.empty() && model.attached.empty() && model.prescribed.empty())
    monitor.warn("{}: no node is held or slides on a surface, so that the tissue is free to fly away; add constraints",
                 scene.file);
  settle_joints(scene.switched_off, model);

  add_fibres(scene, fibres, frame, model, monitor);
  scale_strength(scene, fibres, frame, model, monitor, report);
  if (scene.accuracy.fibres == "spread")
    spread_fibres(model);

  monitor.begin("layers");
  add_thin_layers(volumes, frame, model, monitor);

  turn_families(scene, surfaces, fibres, frame, model, monitor);

  monitor.begin("skin");
  for (const auto bind : { bind_surfaces, bind_contacts, bind_self_contacts, bind_shells })
    bind(scene, surfaces, frame, model, monitor);
  copy_poses(scene, model);

  switch_off(model, scene.switched_off);
  if (measure)
  {
    monitor.begin("muscle volumes");
    report->muscles = measure_muscles(volumes, fibres, model, monitor);
  }
  monitor.begin("check");
  weaken_muscles(scene, frame, model, report);
  check_model(model);
  monitor.finish();
  return model;
}

}  // namespace frontalis
