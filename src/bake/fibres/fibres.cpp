#include "bake/fibres/fibres.hpp"

#include "bake/fibres/fit_nurbs.hpp"
#include "bake/messages.hpp"
#include "bake/shapes/head/head.hpp"
#include "bake/shapes/muscle_net.hpp"

namespace frontalis
{
namespace
{

constexpr double wanted_cells = 1500;  // number of cells in the grid of a muscle
// Below this ratio of length to width the shape alone does not determine the fibre direction.
constexpr double least_distinctness = 1.1;
constexpr double least_kept = 0.9;  // smallest fraction of a muscle that must be in its largest connected component
// largest RMS distance of a fitted volume from the muscle, divided by the muscle's width
constexpr double largest_misfit = 0.25;
constexpr double least_enclosed = 0.5;  // smallest fraction of a muscle that a fitted volume may enclose
constexpr double farthest_end = 0.5;    // largest distance of an origin or insertion, divided by the muscle's length

const char* const remedy = "; give 'origin' and 'insertion', a control 'net', or one direction 'fibre'";

/// The control net of a muscle whose only surface is made from curves, as are those of a generated head; empty for
/// other muscles.
std::optional<ControlNet> made_net(const Scene& scene, const SceneMuscle& muscle)
{
  const auto named = [](const auto& list, const std::string& name)
  { return std::find_if(list.begin(), list.end(), [&](const auto& entry) { return entry.name == name; }); };
  const auto volume = named(scene.volumes, muscle.volume);
  if (muscle.origin.given() || muscle.ring || volume == scene.volumes.end() || volume->inside.size() != 1)
    return std::nullopt;
  const auto surface = named(scene.surfaces, volume->inside.front());
  if (surface == scene.surfaces.end() || !surface->shape)
    return std::nullopt;
  if (surface->shape->kind == Shape::Kind::muscle)
    return curved_muscle_net(*surface->shape);
  return surface->shape->kind == Shape::Kind::head ? head_muscle_net(*surface->shape) : std::nullopt;
}

/// All surfaces that bound a muscle's volume, as one mesh.
TriangleMesh mesh_of(const Volumes::Entry& entry, const Volumes& volumes)
{
  std::vector<std::size_t> bodies = entry.inside;
  if (bodies.empty() && entry.closed_by)
    bodies.push_back(*entry.closed_by);
  if (bodies.empty())
    throw Error("its fibres cannot be found: volume '" + entry.volume->name + "' is bounded by depth alone" + remedy);
  TriangleMesh mesh;
  for (const std::size_t b : bodies)
    append(mesh, volumes.body(b).mesh());
  return mesh;
}

/// Distance from an origin or insertion [m]. Throws Error if it is more than half a muscle's length from the muscle.
std::function<double(const Vector3d&)> distance_from(const MuscleEnd& end, const char* name, const MuscleGrid& grid,
                                                     const PreparedSurfaces& surfaces)
{
  std::function<double(const Vector3d&)> distance;
  if (!end.surface.empty())
  {
    const PreparedSurface* surface = &named_surface(surfaces, end.surface, name);
    // Points below the surface count as being on it.
    distance = [surface](const Vector3d& p)
    { return std::max(0.0, surface->signed_distance(p, surface->tree().closest(p))); };
  }
  else
    distance = [&end](const Vector3d& p)
    {
      double least = (p - to_vector(end.points.front())).squaredNorm();
      for (std::size_t i = 1; i < end.points.size(); ++i)
        least = std::min(least, squared_distance_to_segment(p, to_vector(end.points[i - 1]), to_vector(end.points[i])));
      return std::sqrt(least);
    };
  double least = 1e300;
  Box box;
  for (std::size_t c = 0; c < grid.cells.size(); ++c)
  {
    least = std::min(least, distance(grid.cell_centre(c)));
    box.extend(grid.cell_centre(c));
  }
  const double extent = box.diagonal().norm();
  if (least > farthest_end * extent)
    throw failure("{} is {:.3g} mm away from the muscle, which is {:.3g} mm long; it must be at one of its ends", name,
                  1e3 * least, 1e3 * extent);
  return distance;
}

/// Fits a NURBS volume to a muscle's mesh. `finding` receives a sentence about the quality of the fit.
MuscleFibres fit_muscle(const SceneMuscle& muscle, const TriangleMesh& mesh, const PreparedSurfaces& surfaces,
                        std::string& finding)
{
  // Strands that are separate in fine cells are connected in coarser ones.
  MuscleGrid grid = make_muscle_grid(mesh, wanted_cells);
  for (double coarser = 1.5; grid.kept < least_kept && coarser < 4; coarser *= 1.5)
    grid = make_muscle_grid(mesh, wanted_cells, coarser);
  if (grid.kept < least_kept)
    throw failure(
        "its fibres cannot be found: it is in pieces, the largest of which is {:.0f} % of it; make each piece a muscle "
        "of its own, or give 'net' or 'fibre'",
        100 * grid.kept);

  FibreGuide guide;
  if (muscle.origin.given())
  {
    guide.origin = distance_from(muscle.origin, "origin", grid, surfaces);
    guide.insertion = distance_from(muscle.insertion, "insertion", grid, surfaces);
  }
  else if (!muscle.ring || *muscle.ring)
  {
    guide.ring = find_hole(grid);
    if (muscle.ring && !guide.ring)
      throw Error("ring: it has no hole through its middle; leave 'ring' out, or give a closed control 'net'");
  }
  const FibreCoordinates coordinates = fibre_coordinates(grid, guide);
  if (coordinates.distinctness < least_distinctness)
    throw failure("its fibres cannot be found: its shape is only {:.2f} times as long as wide{}",
                  coordinates.distinctness, remedy);

  NurbsVolume volume = fit_nurbs(grid, coordinates, guide.ring.has_value());
  const NurbsFit fit = measure_fit(volume, grid, TriangleTree(mesh));
  finding = fmt::format(
      "muscle '{}': {} {:.1f} mm long, {:.1f} mm across; NURBS volume {:.4g} cm3 beside {:.4g} cm3 of its surface, of "
      "which it encloses {:.0f} %; rms distance {:.2f} mm",
      muscle.name, guide.ring ? "fibres in rings, on average" : "fibres on average", 1e3 * volume.fibre_length(),
      1e3 * coordinates.width, 1e6 * fit.volume, 1e6 * signed_volume(mesh), 100 * fit.enclosed, 1e3 * fit.distance);
  if (fit.enclosed < least_enclosed)
    throw failure("its fibres cannot be found: the NURBS volume that follows its shape encloses only {:.0f} % of it{}",
                  100 * fit.enclosed, remedy);
  if (fit.distance > largest_misfit * coordinates.width)
    throw failure(
        "its fibres cannot be found: no NURBS volume follows its shape (rms distance {:.2f} mm at a width of {:.1f} "
        "mm){}",
        1e3 * fit.distance, 1e3 * coordinates.width, remedy);
  return { Vector3d::Zero(), std::move(volume), fit.volume, muscle.origin.given() };
}

}  // namespace

std::vector<MuscleFibres> find_fibres(const Scene& scene, const Volumes& volumes, const PreparedSurfaces& surfaces,
                                      BakeMonitor& monitor)
{
  std::vector<MuscleFibres> fibres(scene.muscles.size());
  std::vector<std::string> findings(scene.muscles.size());
  parallel_for(monitor, scene.muscles.size(), 1,
               [&](std::size_t m)
               {
                 const SceneMuscle& muscle = scene.muscles[m];
                 try
                 {
                   if (muscle.net)
                     fibres[m].volume = volume_of(*muscle.net);
                   else if (to_vector(muscle.fibre).norm() > 0)
                     fibres[m].direction = to_vector(muscle.fibre).normalized();
                   else if (const auto net = made_net(scene, muscle))
                   {
                     fibres[m].volume = volume_of(*net);
                     fibres[m].from_origin = !net->ring;
                   }
                   else
                   {
                     const auto entry = std::find_if(volumes.entries().begin(), volumes.entries().end(),
                                                     [m](const auto& e) { return e.muscle == static_cast<int>(m); });
                     fibres[m] = fit_muscle(muscle, mesh_of(*entry, volumes), surfaces, findings[m]);
                   }
                 }
                 catch (const Error& error)
                 {
                   throw Error(place_in_scene(scene, "muscle", muscle) + ": " + error.what());
                 }
               });
  for (const std::string& finding : findings)
    if (!finding.empty())
      monitor.found(finding);
  return fibres;
}

void add_fibres(const Scene& scene, const std::vector<MuscleFibres>& fibres, const LocalFrame& frame, Model& model,
                BakeMonitor& monitor)
{
  parallel_for(monitor, model.voxels.size(), 256,
               [&](std::size_t e)
               {
                 const Vector3d centre = frame.voxel_centre(model, e);
                 for (std::int32_t m = model.fibre_begin[e]; m < model.fibre_begin[e + 1]; ++m)
                 {
                   const int muscle = model.fibre_muscle[m];
                   const Vector3d d = frame.turn(fibres[muscle].at(centre));
                   if (!(d.norm() > 0.5))
                     throw failure(
                         "{}: its fibres have no direction at {}; the control points of its net must not coincide",
                         place_in_scene(scene, "muscle", scene.muscles[muscle]), place_text(centre, scene.unit));
                   Eigen::Map<Eigen::Vector3f>(model.fibre_direction[m].data()) = d.cast<float>();
                 }
               });
}

}  // namespace frontalis
