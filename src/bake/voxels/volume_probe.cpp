#include "bake/voxels/volumes.hpp"

#include "bake/messages.hpp"
#include "bake/mesh/mesh_faults.hpp"

#include <algorithm>

namespace frontalis
{
namespace
{

constexpr int probe_samples = 2000;
constexpr double clear_winding = 0.75;  // smallest winding number of a point that is clearly inside
constexpr double most_unclear = 0.1;    // largest fraction of points inside that are not clearly inside

bool at_depth(const Volumes& volumes, const Volumes::Entry& entry, const Vector3d& p)
{
  if (!entry.within)
    return true;
  const PreparedSurface& surface = *volumes.depth_fields()[*entry.within].surface;
  const ClosestPoint closest = surface.tree().closest(p, entry.reach() * (1 + 1e-9));
  if (closest.triangle < 0)
    return false;
  const double depth = -surface.signed_distance(p, closest);
  return depth >= entry.volume->depth_min && depth <= entry.volume->depth_max;
}

/// Number of the hole that most of the points lie in front of: for a point that which looks largest from there.
std::size_t hole_in_front(const std::vector<MeshFaults::Hole>& holes, const std::vector<Vector3d>& points)
{
  std::vector<int> votes(holes.size(), 0);
  for (const Vector3d& p : points)
  {
    const auto size = [&](const MeshFaults::Hole& hole) { return hole.length / (hole.centre - p).norm(); };
    ++votes[std::max_element(holes.begin(), holes.end(),
                             [&](const auto& a, const auto& b) { return size(a) < size(b); }) -
            holes.begin()];
  }
  return std::max_element(votes.begin(), votes.end()) - votes.begin();
}

void check_opening(const Scene& scene, const Volumes& volumes, const Volumes::Entry& entry, const PreparedSurface& body,
                   bool holds_tissue)
{
  const Box box = body.box().intersection(to_box(entry.volume->crop)).intersection(volumes.tissue_box());
  if (body.closed() || box.isEmpty())
    return;
  int inside = 0;
  std::vector<Vector3d> unclear;
  for (int i = 0; i < probe_samples; ++i)
  {
    const Vector3d p = spread_point(box, i);
    const double w = body.tree().winding_number(p);
    if (w <= 0.5 || !at_depth(volumes, entry, p))
      continue;
    ++inside;
    if (w <= clear_winding)
      unclear.push_back(p);
  }
  // A body outside of the tissue does no harm where it encloses none of it.
  if (inside == 0 ? !holds_tissue : static_cast<double>(unclear.size()) <= most_unclear * inside)
    return;
  const auto holes = find_holes(body.mesh());
  std::string where = "edges at which its triangles do not meet";
  if (!holes.empty())
  {
    const MeshFaults::Hole& hole = holes[hole_in_front(holes, unclear)];
    where = fmt::format("a hole, {} around, at {}", length_text(hole.length, scene.unit),
                        place_text(hole.centre, scene.unit));
  }
  throw failure(
      "{}: surface '{}' is open there: {:.0f} % of what it should enclose lies in front of {}: close it, name the "
      "surface that closes it in 'closed_by', or crop the volume away from it",
      volumes.place(*entry.volume), body.name(),
      inside > 0 ? 100.0 * static_cast<double>(unclear.size()) / inside : 100.0, where);
}

bool contains(const PreparedSurface& body, const Vector3d& p)
{
  if (body.closed() && !body.box().contains(p))
    return false;
  return body.tree().winding_number(p) > 0.5;
}

}  // namespace

Membership membership(const Volumes& volumes, const Volumes::Entry& entry, const Vector3d& p)
{
  const auto in_body = [&](std::size_t b) { return contains(volumes.body(b), p); };
  if (!to_box(entry.volume->crop).contains(p))
    return Membership::cropped;
  if ((entry.closed_by && !in_body(*entry.closed_by)) ||
      (!entry.inside.empty() && std::none_of(entry.inside.begin(), entry.inside.end(), in_body)))
    return Membership::beyond;
  if (std::any_of(entry.outside.begin(), entry.outside.end(), in_body))
    return Membership::excluded;
  if (!entry.within)
    return Membership::inside;
  const PreparedSurface& surface = *volumes.depth_fields()[*entry.within].surface;
  const ClosestPoint closest = surface.tree().closest(p);
  const double depth = -surface.signed_distance(p, closest);
  if (depth < entry.volume->depth_min || depth > entry.volume->depth_max)
    return Membership::wrong_depth;
  const bool hidden =
      entry.any_hiding([&](std::size_t b) { return volumes.body(b).tree().crossed_by(p, closest.point); });
  return hidden ? Membership::hidden : Membership::inside;
}

bool in_tissue(const Volumes& volumes, const Vector3d& p)
{
  const auto& entries = volumes.entries();
  return std::any_of(entries.begin(), entries.end(),
                     [&](const Volumes::Entry& entry)
                     { return entry.volume->tissue && membership(volumes, entry, p) == Membership::inside; });
}

void check_openings(const Scene& scene, const Volumes& volumes)
{
  for (const Volumes::Entry& entry : volumes.entries())
  {
    if (entry.closed_by)
      check_opening(scene, volumes, entry, volumes.body(*entry.closed_by), true);
    for (const std::size_t b : entry.inside)
      check_opening(scene, volumes, entry, volumes.body(b), true);
    for (const std::size_t b : entry.outside)
      check_opening(scene, volumes, entry, volumes.body(b), false);
  }
}

}  // namespace frontalis
