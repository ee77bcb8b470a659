#include "bake/checks.hpp"

#include "bake/messages.hpp"

#include <set>

namespace frontalis
{
namespace
{

constexpr double least_in_tissue = 0.4;   // share of a muscle's volume below which its place is doubtful
constexpr double least_of_muscle = 0.05;  // and below which the bake ends
constexpr double sides_differ = 1.3;      // ratio of these shares of a muscle and its counterpart above which it warns
constexpr double sizes_differ = 1.6;      // ratio of their sizes, in tissue or not, above which it warns

/// Volume that a body encloses [m3]. That of an open one is estimated, by the same rule as that of voxels.
double enclosed_volume(const PreparedSurface& body)
{
  if (body.closed())
    return signed_volume(body.mesh());
  constexpr int points = 20000;
  int inside = 0;
  for (int i = 0; i < points; ++i)
    inside += body.tree().winding_number(spread_point(body.box(), i)) > 0.5 ? 1 : 0;
  return body.box().volume() * inside / points;
}

/// Says which of the tissue's conditions fails for most of the part of a volume that is not tissue, and which surface
/// is the reason; empty if there is no such part.
std::string why_outside(const Volumes& volumes, const Volumes::Entry& volume, const Box& extent)
{
  constexpr int points = 1000;
  std::map<std::string, int> found;
  for (int i = 0; i < points && !extent.isEmpty(); ++i)
  {
    const Vector3d p = spread_point(extent, i);
    const auto around = [&](std::size_t b) { return volumes.body(b).tree().winding_number(p) > 0.5; };
    if (std::none_of(volume.inside.begin(), volume.inside.end(), around) || in_tissue(volumes, p))
      continue;
    std::set<std::string> here;
    for (const Volumes::Entry& entry : volumes.entries())
    {
      if (!entry.volume->tissue)
        continue;
      switch (membership(volumes, entry, p))
      {
        case Membership::cropped:
          here.insert("outside of the tissue's 'crop'");
          break;
        case Membership::beyond:
          here.insert("outside of the skin, or of what else the tissue is 'inside' of");
          break;
        case Membership::excluded:
          for (const std::size_t b : entry.outside)
            if (around(b))
              here.insert(fmt::format("in surface '{}', which the tissue is outside of", volumes.body(b).name()));
          break;
        case Membership::wrong_depth:
          here.insert("deeper, or less deep, than the tissue's 'within' allows");
          break;
        case Membership::hidden:
          here.insert("behind bone");
          break;
        case Membership::inside:
          break;
      }
    }
    for (const std::string& failed : here)
      ++found[failed];
  }
  const auto most =
      std::max_element(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == found.end() ? "" : "; most of what is clipped lies " + most->first;
}

/// Whether a vertex of `one` lies in `other` or within `distance` [m] of it, or an edge of `one` crosses `other`.
bool reaches(const PreparedSurface& one, const PreparedSurface& other, double distance)
{
  const TriangleMesh& mesh = one.mesh();
  const TriangleTree& tree = other.tree();
  for (const Vector3& v : mesh.vertices)
    if (const Vector3d p = to_vector(v); other.box().squaredExteriorDistance(p) <= distance * distance &&
                                         (tree.closest(p, distance).triangle >= 0 || tree.winding_number(p) > 0.5))
      return true;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t c = 0; c < 3; ++c)
      if (tree.crossed_by(vertex(mesh, t[c]), vertex(mesh, t[(c + 1) % 3])))
        return true;
  return false;
}

}  // namespace

void find_surfaces_apart(const Scene& scene, const Volumes& volumes, BakeMonitor& monitor)
{
  const Box tissue = volumes.tissue_box();
  const double voxel = to_vector(scene.accuracy.voxel).minCoeff();
  std::set<std::string> told;
  for (const Volumes::Entry& entry : volumes.entries())
    for (const std::size_t b : entry.outside)
    {
      const PreparedSurface& body = volumes.body(b);
      if (!entry.volume->tissue)
        continue;
      const auto apart = [&](std::size_t around)
      { return !reaches(body, volumes.body(around), voxel) && !reaches(volumes.body(around), body, voxel); };
      if (!body.box().intersects(tissue) && told.insert(body.name()).second)
        monitor.warn("surface '{}' bounds no tissue: it spans {}, the tissue {}; check its place and its length unit",
                     body.name(), box_text(body.box(), scene.unit), box_text(tissue, scene.unit));
      else if (body.box().diagonal().norm() < voxel && told.insert(body.name()).second)
        monitor.warn("surface '{}' is smaller than a voxel: it spans {}; check its length unit", body.name(),
                     box_text(body.box(), scene.unit));
      else if (!entry.inside.empty() && std::all_of(entry.inside.begin(), entry.inside.end(), apart) &&
               told.insert(body.name()).second)
        monitor.warn("surface '{}' lies wholly outside of '{}' and bounds no tissue: it spans {}; check its place",
                     body.name(), volumes.body(entry.inside.front()).name(), box_text(body.box(), scene.unit));
    }
}

void check_volumes(const Scene& scene, const Volumes& volumes, const Voxels& voxels, BakeMonitor& monitor)
{
  struct Size
  {
    double in_tissue = 0;  // share of the volume
    double volume = 0;     // [m3]
  };
  std::map<std::string, Size> muscles;
  for (std::size_t v = 0; v < volumes.entries().size(); ++v)
  {
    const Volumes::Entry& entry = volumes.entries()[v];
    const double size = voxels.volume_size[v];
    const std::string muscle = entry.muscle < 0 ? "" : "muscle '" + scene.muscles[entry.muscle].name + "'";
    Box extent;
    for (const std::size_t b : entry.inside)
      extent.extend(volumes.body(b).box());
    if (size <= 0 && entry.volume->tissue)
      throw Error(volumes.place(*entry.volume) +
                  ": is empty: no point is inside its surfaces, outside the others, at its depth and in its crop; "
                  "check these, the units and the voxel size");
    if (size <= 0)
      throw failure(
          "{}: {}, or is thinner than the sample spacing{}{}; check its surfaces, their length units, its crop "
          "and the voxel size",
          volumes.place(*entry.volume),
          muscle.empty() ? "no point of it lies in the tissue" : muscle + " lies wholly outside the tissue",
          extent.isEmpty() ? ""
                           : ": its surfaces span " + box_text(extent, scene.unit) + ", the tissue " +
                                 box_text(volumes.tissue_box(), scene.unit),
          why_outside(volumes, entry, extent));
    if (muscle.empty() || entry.closed_by || entry.inside.empty())
      continue;
    double whole = 0;
    bool closed = true;
    for (const std::size_t b : entry.inside)
    {
      whole += enclosed_volume(volumes.body(b));
      closed = closed && volumes.body(b).closed();
    }
    monitor.found("{}: {:.4g} cm3 in the tissue, {:.4g} cm3 by its surface ({:.0f} % clipped){}", muscle, 1e6 * size,
                  1e6 * whole, 100 * std::max(0.0, 1 - size / whole), closed ? "" : "; the surface is open");
    muscles[scene.muscles[entry.muscle].name] = { size / whole, whole };
    if (size < least_of_muscle * whole)
      throw failure(
          "{}: {} lies in the tissue with only {:.2g} % of its volume; its surface spans {}{}: check the places of "
          "both",
          volumes.place(*entry.volume), muscle, 100 * size / whole, box_text(extent, scene.unit),
          why_outside(volumes, entry, extent));
    if (size < least_in_tissue * whole)
      monitor.warn(
          "{} lies in the tissue with {:.0f} % of its volume; its surface spans {}{}: see the table of muscles that "
          "--report prints, and check the places of both",
          muscle, 100 * size / whole, box_text(extent, scene.unit), why_outside(volumes, entry, extent));
  }
  const auto differ = [](double a, double b, double ratio) { return std::max(a, b) > ratio * std::min(a, b); };
  for (const auto& [name, here] : muscles)
  {
    const auto other = counterpart(muscles, name);
    if (other == muscles.end())
      continue;
    const Size& there = other->second;
    if (differ(here.in_tissue, there.in_tissue, sides_differ))
      monitor.warn(
          "muscle '{}' lies in the tissue with {:.0f} % of its volume, '{}' with {:.0f} %: the face will move "
          "more on one side; check both surfaces, and the bones near them",
          name, 100 * here.in_tissue, other->first, 100 * there.in_tissue);
    if (differ(here.volume, there.volume, sizes_differ))
      monitor.warn(
          "muscle '{}' has {:.3g} cm3, '{}' {:.3g} cm3: the face will move more on one side; check whether one "
          "surface is incomplete or belongs to both sides",
          name, 1e6 * here.volume, other->first, 1e6 * there.volume);
  }
}

}  // namespace frontalis
