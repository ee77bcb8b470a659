#include "frontalis/error.hpp"
#include "bake/mesh/load_surface.hpp"
#include "bake/parallel.hpp"
#include "bake/voxels/spread_points.hpp"
#include "bake/mesh/surface.hpp"

#include <cmath>

namespace frontalis
{

std::vector<std::unique_ptr<PreparedSurface>> prepare_surfaces(const Scene& scene, BakeStages& stages)
{
  std::vector<std::unique_ptr<PreparedSurface>> prepared(scene.surfaces.size());
  std::vector<LoadedSurface> loaded(scene.surfaces.size());
  parallel_for(
      scene.surfaces.size(),
      [&](std::size_t s)
      {
        const Surface& surface = scene.surfaces[s];
        try
        {
          loaded[s] = load_surface(surface, scene.unit);
          prepared[s] = std::make_unique<PreparedSurface>(surface.name, std::move(loaded[s].mesh), surface.line);
        }
        catch (const Error& error)
        {
          throw Error(scene.file + ":" + std::to_string(surface.line) + ": surface '" + surface.name +
                      "': " + error.what());
        }
      },
      &stages);
  for (const LoadedSurface& surface : loaded)
  {
    for (const std::string& finding : surface.findings)
      stages.found(finding);
  }
  return prepared;
}

TriangleMesh join_surfaces(const std::vector<const PreparedSurface*>& parts)
{
  Box box;
  for (const PreparedSurface* part : parts)
    box.include(part->box());

  // winding numbers of each part at points spread over the box
  constexpr int points = 400;
  std::vector<std::vector<double>> winding(parts.size(), std::vector<double>(points));
  for (int i = 0; i < points; ++i)
  {
    const Vector3 p = spread_point(box, i);
    for (std::size_t s = 0; s < parts.size(); ++s)
      winding[s][static_cast<std::size_t>(i)] = parts[s]->tree().winding_number(p);
  }

  // of all ways to turn the parts, the one whose sum is nearest to whole numbers; the first part decides the overall
  // sense
  const std::size_t ways = parts.size() > 12 ? 1 : std::size_t{ 1 } << (parts.size() - 1);
  std::size_t best = 0;
  double least = 1e300;
  double sense = 1;
  for (std::size_t way = 0; way < ways; ++way)
  {
    double fault = 0, sum = 0;
    for (std::size_t i = 0; i < points; ++i)
    {
      double w = winding[0][i];
      for (std::size_t s = 1; s < parts.size(); ++s)
        w += (way >> (s - 1) & 1) != 0 ? -winding[s][i] : winding[s][i];
      fault += (w - std::round(w)) * (w - std::round(w));
      sum += w;
    }
    if (fault < least - 1e-9)
    {
      least = fault;
      best = way;
      sense = sum < 0 ? -1 : 1;
    }
  }

  TriangleMesh mesh;
  for (std::size_t s = 0; s < parts.size(); ++s)
  {
    const bool turned = (s > 0 && (best >> (s - 1) & 1) != 0) != (sense < 0);
    const auto base = static_cast<std::int32_t>(mesh.vertices.size());
    const TriangleMesh& part = parts[s]->mesh();
    mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
    for (const Triangle& t : part.triangles)
      mesh.triangles.push_back(turned ? Triangle{ base + t[0], base + t[2], base + t[1] }
                                      : Triangle{ base + t[0], base + t[1], base + t[2] });
  }
  join_vertices(mesh);
  return mesh;
}

}  // namespace frontalis
