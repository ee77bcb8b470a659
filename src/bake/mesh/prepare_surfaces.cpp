#include "frontalis/error.hpp"
#include "bake/mesh/load_surface.hpp"
#include "bake/messages.hpp"
#include "bake/parallel.hpp"
#include "bake/mesh/spread_points.hpp"
#include "bake/mesh/surface.hpp"

#include <cmath>

namespace frontalis
{

PreparedSurfaces prepare_surfaces(const Scene& scene, BakeMonitor& monitor)
{
  PreparedSurfaces prepared(scene.surfaces.size());
  std::vector<LoadedSurface> loaded(scene.surfaces.size());
  parallel_for(monitor, scene.surfaces.size(), 1,
               [&](std::size_t s)
               {
                 const Surface& surface = scene.surfaces[s];
                 try
                 {
                   loaded[s] = load_surface(surface, scene.unit);
                 }
                 catch (const Error& error)
                 {
                   throw Error(place_in_scene(scene, "surface", surface) + ": " + error.what());
                 }
                 prepared[s] = std::make_unique<PreparedSurface>(surface.name, std::move(loaded[s].mesh), surface.line);
               });
  for (const LoadedSurface& surface : loaded)
    for (const std::string& finding : surface.findings)
      monitor.found(finding);
  return prepared;
}

TriangleMesh join_surfaces(const std::vector<const PreparedSurface*>& parts)
{
  Box box;
  for (const PreparedSurface* part : parts)
    box.extend(part->box());

  // winding numbers of each part at points spread over the box
  constexpr int points = 400;
  std::vector<std::vector<double>> winding(parts.size(), std::vector<double>(points));
  for (int i = 0; i < points; ++i)
  {
    const Vector3d p = spread_point(box, i);
    for (std::size_t s = 0; s < parts.size(); ++s)
      winding[s][i] = parts[s]->tree().winding_number(p);
  }

  // The orientation of a part is not known from itself. Of all combinations take the one whose sums of winding numbers
  // are nearest to whole numbers; the first part is then flipped, with all others, where these sums are negative.
  constexpr std::size_t most_combined_parts = 12;
  const std::size_t combinations = parts.size() > most_combined_parts ? 1 : std::size_t{ 1 } << (parts.size() - 1);
  const auto is_flipped = [](std::size_t combination, std::size_t part)
  { return part > 0 && (combination >> (part - 1) & 1) != 0; };
  std::size_t best = 0;
  double least = 1e300;
  bool negative = false;
  for (std::size_t combination = 0; combination < combinations; ++combination)
  {
    double error = 0, sum = 0;
    for (std::size_t i = 0; i < points; ++i)
    {
      double w = 0;
      for (std::size_t s = 0; s < parts.size(); ++s)
        w += is_flipped(combination, s) ? -winding[s][i] : winding[s][i];
      error += (w - std::round(w)) * (w - std::round(w));
      sum += w;
    }
    if (error < least - 1e-9)
    {
      least = error;
      best = combination;
      negative = sum < 0;
    }
  }

  TriangleMesh mesh;
  for (std::size_t s = 0; s < parts.size(); ++s)
    append(mesh, parts[s]->mesh(), is_flipped(best, s) != negative);
  join_vertices(mesh);
  return mesh;
}

}  // namespace frontalis
