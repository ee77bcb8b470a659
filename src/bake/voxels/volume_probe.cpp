#include "bake/voxels/volume_probe.hpp"

#include "frontalis/error.hpp"
#include "bake/length_text.hpp"
#include "bake/mesh/mesh_faults.hpp"
#include "bake/voxels/spread_points.hpp"

#include <algorithm>
#include <cstdio>

namespace frontalis
{
namespace
{

constexpr int samples = 2000;
constexpr double sure = 0.75;
constexpr double most_unsure = 0.1;

/// The part of a volume's crop, and of the tissue's box, where a body lies.
Box region_of(const Volumes::Entry& entry, const Volumes::Solid& solid, const Box& tissue)
{
  Box box = solid.surface->box();
  box.intersect(entry.volume->crop);
  Region region;
  region.lower = tissue.lower;
  region.upper = tissue.upper;
  box.intersect(region);
  return box;
}

bool at_depth(const Volumes& volumes, const Volumes::Entry& entry, const Vector3& p)
{
  if (entry.within < 0)
    return true;
  const PreparedSurface& surface = *volumes.depths()[static_cast<std::size_t>(entry.within)].surface;
  const ClosestPoint closest = surface.tree().closest(p, entry.volume->depth_max * (1 + 1e-9));
  if (closest.triangle < 0)
    return false;
  const double depth = -surface.signed_distance(p, closest);
  return depth >= entry.volume->depth_min && depth <= entry.volume->depth_max;
}

void check_opening(const Scene& scene, const Volumes& volumes, const Volumes::Entry& entry, const Volumes::Solid& solid)
{
  const Box box = region_of(entry, solid, volumes.tissue_box());
  if (solid.surface->closed() || box.empty())
    return;
  int clear = 0, unsure = 0;
  for (int i = 0; i < samples; ++i)
  {
    const Vector3 p = spread_point(box, i);
    const double w = solid.surface->tree().winding_number(p);
    if (w > 0.5 && at_depth(volumes, entry, p))
      ++(w > sure ? clear : unsure);
  }
  if (unsure + clear > 0 && unsure <= most_unsure * (unsure + clear))
    return;
  char share[32];
  std::snprintf(share, sizeof(share), "%.0f %%", clear + unsure > 0 ? 100.0 * unsure / (clear + unsure) : 100.0);
  const auto holes = find_holes(solid.surface->mesh());
  throw Error(volumes.place(*entry.volume) + ": surface '" + solid.surface->name() + "' is open there: " + share +
              " of what it should enclose lies in front of a hole" +
              (holes.empty() ? std::string("; it has edges at which its triangles do not meet")
                             : "; the largest of its " + std::to_string(holes.size()) + " holes is " +
                                   length_text(holes.front().length, scene.unit) + " around, at " +
                                   place_text(holes.front().centre, scene.unit)) +
              ": close it, name the surface that closes it in 'closed_by', or crop the volume away from it");
}

}  // namespace

bool holds(const Volumes::Solid& solid, const Vector3& p)
{
  if (solid.surface->closed() && solid.surface->box().squared_distance(p) > 0)
    return false;
  return solid.surface->tree().winding_number(p) > 0.5;
}

Standing standing(const Volumes& volumes, const Volumes::Entry& entry, const Vector3& p)
{
  const auto held = [&](int s) { return holds(volumes.solids()[static_cast<std::size_t>(s)], p); };
  if (!contains(entry.volume->crop, p))
    return Standing::cropped;
  if ((entry.closed_by >= 0 && !held(entry.closed_by)) ||
      (!entry.inside.empty() && std::none_of(entry.inside.begin(), entry.inside.end(), held)))
    return Standing::beyond;
  if (std::any_of(entry.outside.begin(), entry.outside.end(), held))
    return Standing::excluded;
  if (entry.within < 0)
    return Standing::inside;
  const PreparedSurface& surface = *volumes.depths()[static_cast<std::size_t>(entry.within)].surface;
  const ClosestPoint closest = surface.tree().closest(p);
  const double depth = -surface.signed_distance(p, closest);
  if (depth < entry.volume->depth_min || depth > entry.volume->depth_max)
    return Standing::too_deep;
  const auto crosses = [&](int s)
  { return volumes.solids()[static_cast<std::size_t>(s)].surface->tree().crossed_by(p, closest.point); };
  return std::any_of(entry.outside.begin(), entry.outside.begin() + static_cast<std::ptrdiff_t>(entry.hiding), crosses)
             ? Standing::hidden
             : Standing::inside;
}

void check_openings(const Scene& scene, const Volumes& volumes)
{
  for (const Volumes::Entry& entry : volumes.entries())
  {
    const auto check = [&](int s)
    { check_opening(scene, volumes, entry, volumes.solids()[static_cast<std::size_t>(s)]); };
    if (entry.closed_by >= 0)
      check(entry.closed_by);
    for (const int s : entry.inside)
      check(s);
    for (const int s : entry.outside)
      check(s);
  }
}

}  // namespace frontalis
