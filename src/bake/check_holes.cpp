#include "bake/checks.hpp"

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
constexpr double places_differ = 15e-3;  // [m] between a hole and the mirror image of its counterpart

/// The holes of a surface from a file, largest first; of a surface that is made, none.
Holes holes_of_file(const Scene& scene, const PreparedSurface& surface)
{
  const auto is_file = [&](const Surface& given) { return given.name == surface.name() && !given.file.empty(); };
  if (surface.closed() || std::none_of(scene.surfaces.begin(), scene.surfaces.end(), is_file))
    return {};
  Holes holes = find_holes(surface.mesh());
  holes.erase(std::remove_if(holes.begin(), holes.end(), [](const auto& hole) { return hole.length < smallest; }),
              holes.end());
  return holes;
}

/// Whether a hole is on one side of the face, and none like it is on the other side.
bool is_one_sided(const MeshFaults::Hole& hole, const Holes& holes, const MiddlePlane& middle)
{
  const double aside = middle.left.dot(hole.centre) - middle.offset;
  const Vector3d mirrored = hole.centre - 2 * aside * middle.left;
  const auto is_counterpart = [&](const MeshFaults::Hole& other)
  {
    return (mirrored - other.centre).norm() < places_differ &&
           std::max(hole.length, other.length) < lengths_differ * std::min(hole.length, other.length);
  };
  return std::abs(aside) > off_the_middle && std::none_of(holes.begin(), holes.end(), is_counterpart);
}

}  // namespace

void check_holes(const Scene& scene, const PreparedSurfaces& surfaces, const Volumes& volumes, BakeMonitor& monitor)
{
  const Box tissue = volumes.tissue_box();
  const auto in_tissue = [&](const MeshFaults::Hole& hole) { return tissue.contains(hole.centre); };
  const auto text = [&](const MeshFaults::Hole& hole)
  { return length_text(hole.length, scene.unit) + " around at " + place_text(hole.centre, scene.unit); };
  std::set<std::string> told;
  for (const Volumes::Entry& entry : volumes.entries())
    for (const std::size_t b : entry.outside)
    {
      const PreparedSurface& body = volumes.body(b);
      if (!entry.volume->tissue || !told.insert(body.name()).second)
        continue;
      const Holes holes = holes_of_file(scene, body);
      if (const auto hole = std::find_if(holes.begin(), holes.end(), in_tissue); hole != holes.end())
        monitor.warn("surface '{}' has a hole {}; tissue takes the place of what is missing there: close it",
                     body.name(), text(*hole));
    }
  const std::optional<MiddlePlane> middle = middle_plane(surfaces);
  for (const auto& surface : surfaces)
  {
    if (surface->name() != scene.skin.surface || !middle)
      continue;
    const Holes holes = holes_of_file(scene, *surface);
    for (const MeshFaults::Hole& hole : holes)
      if (in_tissue(hole) && is_one_sided(hole, holes, *middle))
        monitor.warn("surface '{}' has a hole {}, on one side of the face alone; close it, if skin is missing there",
                     surface->name(), text(hole));
  }
}

}  // namespace frontalis
