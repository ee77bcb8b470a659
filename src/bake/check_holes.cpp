#include "bake/check_holes.hpp"

#include "bake/mesh/mesh_faults.hpp"
#include "bake/messages.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace frontalis
{
namespace
{

using Holes = std::vector<MeshFaults::Hole>;

constexpr double smallest = 20e-3;       // length of the border of a hole that matters [m]
constexpr double off_the_middle = 8e-3;  // [m] from the middle of the face, from which a hole is on one side
constexpr double lengths_differ = 1.6;   // ratio of the lengths of a hole and its counterpart
constexpr double beside = 0.95;          // least cosine between their connection and the direction to the left

/// The holes of a surface from a file that lie in the tissue, largest first.
Holes holes_in_tissue(const Scene& scene, const PreparedSurface& surface, const Box& tissue)
{
  const auto is_file = [&](const Surface& given) { return given.name == surface.name() && !given.file.empty(); };
  if (surface.closed() || std::none_of(scene.surfaces.begin(), scene.surfaces.end(), is_file))
    return {};
  Holes holes = find_holes(surface.mesh());
  const auto is_harmless = [&](const MeshFaults::Hole& hole)
  { return hole.length < smallest || !tissue.contains(hole.centre); };
  holes.erase(std::remove_if(holes.begin(), holes.end(), is_harmless), holes.end());
  return holes;
}

bool has_counterpart(const MeshFaults::Hole& hole, const Holes& holes, const Vector3d& left)
{
  return std::any_of(holes.begin(), holes.end(),
                     [&](const MeshFaults::Hole& other)
                     {
                       const Vector3d apart = hole.centre - other.centre;
                       return std::abs(left.dot(apart)) > beside * apart.norm() &&
                              std::max(hole.length, other.length) <
                                  lengths_differ * std::min(hole.length, other.length);
                     });
}

}  // namespace

void check_holes(const Scene& scene, const PreparedSurfaces& surfaces, const Volumes& volumes, BakeMonitor& monitor)
{
  const Box tissue = volumes.tissue_box();
  const auto text = [&](const MeshFaults::Hole& hole)
  { return length_text(hole.length, scene.unit) + " around at " + place_text(hole.centre, scene.unit); };
  std::set<std::string> told;
  for (const Volumes::Entry& entry : volumes.entries())
    for (const std::size_t b : entry.outside)
    {
      const PreparedSurface& body = volumes.body(b);
      if (!entry.volume->tissue || !told.insert(body.name()).second)
        continue;
      if (const Holes holes = holes_in_tissue(scene, body, tissue); !holes.empty())
        monitor.warn("surface '{}' has a hole {}, through which tissue enters it: close it", body.name(),
                     text(holes.front()));
    }
  for (const auto& surface : surfaces)
  {
    if (surface->name() != scene.skin.surface)
      continue;
    const Vector3d left = to_vector(scene.frame.up).cross(to_vector(scene.frame.forward)).normalized();
    const Holes holes = holes_in_tissue(scene, *surface, tissue);
    for (const MeshFaults::Hole& hole : holes)
      if (std::abs(left.dot(hole.centre - to_vector(scene.frame.origin))) > off_the_middle &&
          !has_counterpart(hole, holes, left))
        monitor.warn("surface '{}' has a hole {}, on one side of the face alone; close it, if skin is missing there",
                     surface->name(), text(hole));
  }
}

}  // namespace frontalis
