#include "bake/fibres/fibres.hpp"

#include "bake/fibres/fit_nurbs.hpp"
#include "frontalis/error.hpp"
#include "bake/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace frontalis
{
namespace
{

constexpr double wanted_cells = 1500;
/// Ratio of length to width from which a shape alone tells along which of both its fibres run.
constexpr double least_distinctness = 1.1;

const char* const remedy = "; give 'origin' and 'insertion', a control 'net', or one direction 'fibre'";

std::string text(const char* format, double a, double b = 0)
{
  char buffer[160];
  std::snprintf(buffer, sizeof(buffer), format, a, b);
  return buffer;
}

NurbsVolume volume_of(const ControlNet& net)
{
  const auto axis = [&net](std::size_t a)
  { return SplineAxis(std::min(3, net.size[a] - 1), net.size[a], a == 0 && net.ring); };
  return NurbsVolume({ { axis(0), axis(1), axis(2) } }, net.points, net.weights);
}

/// Surfaces of a muscle's volume as one mesh.
TriangleMesh mesh_of(const Volumes::Entry& entry, const Volumes& volumes)
{
  std::vector<int> solids = entry.inside;
  if (solids.empty() && entry.closed_by >= 0)
    solids.push_back(entry.closed_by);
  if (solids.empty())
    throw Error("its fibres cannot be found: volume '" + entry.volume->name + "' is bounded by depth alone" + remedy);
  TriangleMesh mesh;
  for (const int s : solids)
  {
    const TriangleMesh& part = volumes.solids()[static_cast<std::size_t>(s)].surface->mesh();
    const auto base = static_cast<std::int32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
    for (const Triangle& t : part.triangles)
      mesh.triangles.push_back({ base + t[0], base + t[1], base + t[2] });
  }
  return mesh;
}

double distance_to_line(const Vector3& p, const Vector3& a, const Vector3& b)
{
  const Vector3 along = b - a;
  const double squared = dot(along, along);
  const double t = squared > 0 ? std::min(1.0, std::max(0.0, dot(p - a, along) / squared)) : 0;
  return norm(p - a - t * along);
}

/// Distance from an end [m]; an end as far away as the muscle is long is a mistake.
std::function<double(const Vector3&)> distance_from(const MuscleEnd& end, const char* name, const MuscleGrid& grid,
                                                    const std::vector<std::unique_ptr<PreparedSurface>>& surfaces)
{
  std::function<double(const Vector3&)> distance;
  if (!end.surface.empty())
  {
    const PreparedSurface* surface = &named_surface(surfaces, end.surface, name);
    // below the surface is at it
    distance = [surface](const Vector3& p)
    { return std::max(0.0, surface->signed_distance(p, surface->tree().closest(p))); };
  }
  else
    distance = [&end](const Vector3& p)
    {
      double least = norm(p - end.points.front());
      for (std::size_t i = 1; i < end.points.size(); ++i)
        least = std::min(least, distance_to_line(p, end.points[i - 1], end.points[i]));
      return least;
    };
  double least = 1e300;
  Box box;
  for (std::size_t c = 0; c < grid.cells.size(); ++c)
  {
    least = std::min(least, distance(grid.cell_centre(c)));
    box.include(grid.cell_centre(c));
  }
  const double extent = norm(box.upper - box.lower);
  if (least > 0.5 * extent)
    throw Error(std::string(name) +
                text(" is %.3g mm away from the muscle, which is %.3g mm long; it must be at one of its ends",
                     1e3 * least, 1e3 * extent));
  return distance;
}

struct Fitted
{
  NurbsVolume volume;
  double size;  // [m3]
  std::string finding;
};

Fitted fit_muscle(const SceneMuscle& muscle, const TriangleMesh& mesh,
                  const std::vector<std::unique_ptr<PreparedSurface>>& surfaces)
{
  // strands that lie apart are joined by coarser cells
  MuscleGrid grid = make_muscle_grid(mesh, wanted_cells);
  for (double coarser = 1.5; grid.kept < 0.9 && coarser < 4; coarser *= 1.5)
    grid = make_muscle_grid(mesh, wanted_cells, coarser);
  if (grid.kept < 0.9)
    throw Error("its fibres cannot be found: it is in pieces, the largest of which is " +
                text("%.0f %% of it; make each piece a muscle of its own, or give 'net' or 'fibre'", 100 * grid.kept));

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
    throw Error("its fibres cannot be found: its shape is " +
                text("only %.2f times as long as wide", coordinates.distinctness) + remedy);

  Fitted fitted{ fit_nurbs(grid, coordinates, guide.ring.has_value()), 0, {} };
  const NurbsFit fit = measure_fit(fitted.volume, grid, TriangleTree(mesh));
  fitted.size = fit.volume;
  fitted.finding =
      "muscle '" + muscle.name + "': " + (guide.ring ? "fibres in rings, on average " : "fibres on average ") +
      text("%.1f mm long, %.1f mm across; NURBS volume ", 1e3 * coordinates.length, 1e3 * coordinates.width) +
      text("%.4g cm3 beside %.4g cm3 of its surface, ", 1e6 * fit.volume, 1e6 * signed_volume(mesh)) +
      text("of which it encloses %.0f %%; rms distance %.2f mm", 100 * fit.enclosed, 1e3 * fit.distance);
  if (fit.distance > 0.25 * coordinates.width)
    throw Error("its fibres cannot be found: no NURBS volume follows its shape" +
                text(" (rms distance %.2f mm at a width of %.1f mm)", 1e3 * fit.distance, 1e3 * coordinates.width) +
                remedy);
  return fitted;
}

}  // namespace

std::vector<MuscleFibres> find_fibres(const Scene& scene, const Volumes& volumes,
                                      const std::vector<std::unique_ptr<PreparedSurface>>& surfaces, BakeStages& stages)
{
  std::vector<MuscleFibres> fibres(scene.muscles.size());
  std::vector<std::string> findings(scene.muscles.size());
  parallel_for(
      scene.muscles.size(),
      [&](std::size_t m)
      {
        const SceneMuscle& muscle = scene.muscles[m];
        try
        {
          if (muscle.net)
            fibres[m].volume = volume_of(*muscle.net);
          else if (norm(muscle.fibre) > 0)
            fibres[m].direction = normalised(muscle.fibre);
          else
          {
            const auto entry = std::find_if(volumes.entries().begin(), volumes.entries().end(),
                                            [m](const auto& e) { return e.muscle == static_cast<int>(m); });
            Fitted fitted = fit_muscle(muscle, mesh_of(*entry, volumes), surfaces);
            fibres[m].volume = std::move(fitted.volume);
            fibres[m].fitted_size = fitted.size;
            findings[m] = std::move(fitted.finding);
          }
        }
        catch (const Error& error)
        {
          throw Error(scene.file + ":" + std::to_string(muscle.line) + ": muscle '" + muscle.name +
                      "': " + error.what());
        }
      },
      &stages);
  for (const std::string& finding : findings)
    if (!finding.empty())
      stages.found(finding);
  return fibres;
}

void add_fibres(const Scene& scene, const std::vector<MuscleFibres>& fibres, const LocalFrame& frame, Model& model,
                BakeStages& stages)
{
  parallel_ranges(
      model.voxels.size(), 256,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t e = begin; e < end; ++e)
        {
          Vector3 centre{};
          for (std::size_t a = 0; a < 3; ++a)
            centre[frame.scene_axis(a)] =
                frame.origin[frame.scene_axis(a)] + (model.voxels[e][a] + 0.5) * model.spacing[a];
          for (auto m = static_cast<std::size_t>(model.fibre_begin[e]);
               m < static_cast<std::size_t>(model.fibre_begin[e + 1]); ++m)
          {
            const auto muscle = static_cast<std::size_t>(model.fibre_muscle[m]);
            const Vector3 d = frame.turn(fibres[muscle].at(centre));
            if (!(norm(d) > 0.5))
              throw Error(scene.file + ":" + std::to_string(scene.muscles[muscle].line) + ": muscle '" +
                          scene.muscles[muscle].name + "': its fibres have no direction at " +
                          text("(%.4g, %.4g, ", centre[0], centre[1]) +
                          text("%.4g) m; control points of its net must not fall together", centre[2]));
            model.fibre_direction[m] = { static_cast<float>(d[0]), static_cast<float>(d[1]), static_cast<float>(d[2]) };
          }
        }
      },
      &stages);
}

}  // namespace frontalis
