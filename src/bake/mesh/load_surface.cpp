#include "bake/mesh/load_surface.hpp"

#include "frontalis/bake/forehead_shape.hpp"
#include "frontalis/error.hpp"
#include "bake/length_text.hpp"
#include "bake/mesh/mesh_repairs.hpp"
#include "bake/voxels/spread_points.hpp"
#include "bake/mesh/surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace frontalis
{
namespace
{

constexpr double most_enclosed_twice = 0.02;
constexpr double deepest_overlap = 0.04;
constexpr double widest_crossing = 0.05;
constexpr int overlap_samples = 10000;

/// An open mesh is inside-out where it encloses a place negatively: the largest winding number in its bounding box.
bool open_and_inside_out(const TriangleMesh& mesh)
{
  const TriangleTree tree(mesh);
  const Box box = bounding_box(mesh);
  double strongest = 0;
  for (int i = 0; i < 216; ++i)
  {
    const double w = tree.winding_number(spread_point(box, i));
    if (std::abs(w) > std::abs(strongest))
      strongest = w;
  }
  // a patch or a dome encloses nothing well enough to tell
  return strongest < -0.75;
}

/// What crossing pieces enclose twice, or from outside.
struct Overlap
{
  double share = 0;  ///< of what they enclose
  double depth = 0;  ///< largest distance of such a point from the surface [m]
  double size = 0;   ///< cube root of what they enclose [m]
  Vector3 deepest{ 0, 0, 0 };
};

Overlap find_overlap(const TriangleMesh& mesh, const MeshFaults& faults)
{
  std::vector<bool> keep(mesh.triangles.size());
  for (std::size_t t = 0; t < keep.size(); ++t)
    keep[t] = faults.crossing_piece[static_cast<std::size_t>(faults.piece[t])];
  const TriangleMesh pieces = keep_triangles(mesh, keep);
  const TriangleTree tree(pieces);
  const Box box = bounding_box(pieces);
  const Vector3 sides = box.upper - box.lower;
  Overlap overlap;
  int enclosed = 0, wrong = 0;
  for (int i = 0; i < overlap_samples; ++i)
  {
    const Vector3 p = spread_point(box, i);
    const double w = tree.winding_number(p);
    enclosed += w > 0.5 || w < -0.5 ? 1 : 0;
    if (w <= 1.5 && w >= -0.5)
      continue;
    ++wrong;
    const double depth = tree.closest(p).distance;
    if (depth <= overlap.depth)
      continue;
    overlap.depth = depth;
    overlap.deepest = p;
  }
  overlap.share = enclosed > 0 ? static_cast<double>(wrong) / enclosed : 0;
  overlap.size = std::cbrt(sides[0] * sides[1] * sides[2] * enclosed / overlap_samples);
  return overlap;
}

std::string number(std::size_t count, const std::string& one, const std::string& many)
{
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

void refuse(const TriangleMesh& mesh, const MeshFaults& faults, bool closed, double unit)
{
  if (faults.fins.count > 0)
    throw Error("at " + number(faults.fins.count, "edge", "edges") +
                " an odd number of triangles meet (non-manifold), the first at " + place_text(faults.fins.place, unit) +
                ": nothing says which side is inside; take the surplus triangles away in a modelling tool");
  double area = 0;
  for (const Triangle& t : mesh.triangles)
  {
    const Vector3& a = mesh.vertices[static_cast<std::size_t>(t[0])];
    area += 0.5 * norm(cross(mesh.vertices[static_cast<std::size_t>(t[1])] - a,
                             mesh.vertices[static_cast<std::size_t>(t[2])] - a));
  }
  if (closed && std::abs(signed_volume(mesh)) < 1e-7 * std::pow(area, 1.5))
    throw Error("is closed but encloses nothing: it has no thickness at " +
                place_text(bounding_box(mesh).centre(), unit) +
                "; give it one, or use an open sheet that bounds a volume together with others");
  if (faults.crossings.count == 0)
    return;

  const Overlap overlap = find_overlap(mesh, faults);
  char share[32];
  std::snprintf(share, sizeof(share), "%.2g %%", 100 * overlap.share);
  const std::string crossing =
      "passes through itself: " + number(faults.crossings.count, "pair", "pairs") + " of triangles cross, ";
  if (overlap.share > most_enclosed_twice || overlap.depth > deepest_overlap * overlap.size)
    throw Error(crossing + "and " + share + " of what it encloses is enclosed twice or from outside, deepest (" +
                length_text(overlap.depth, unit) + ") at " + place_text(overlap.deepest, unit) +
                "; unite the parts in a modelling tool, or give each a file and a surface of its own");
  const Box box = bounding_box(mesh);
  if (!closed && faults.crossing_extent > widest_crossing * norm(box.upper - box.lower))
    throw Error(crossing + "over " + length_text(faults.crossing_extent, unit) + " around " +
                place_text(faults.crossings.place, unit) +
                "; take one of the sheets away in a modelling tool, or give each a file and a surface of its own");
}

std::vector<std::string> repairs_told(const MeshRepairs& repairs)
{
  std::vector<std::string> told;
  const auto tell = [&told](std::size_t count, const std::string& one, const std::string& many)
  {
    if (count > 0)
      told.push_back(number(count, one, many));
  };
  tell(repairs.collapsed, "triangle with a corner twice left out", "triangles with a corner twice left out");
  tell(repairs.repeated, "triangle that was there already left out", "triangles that were there already left out");
  tell(repairs.back_to_back, "pair of triangles back to back left out", "pairs of triangles back to back left out");
  tell(repairs.flat, "triangle without area left out", "triangles without area left out");
  tell(repairs.turned, "triangle turned to agree with its neighbours",
       "triangles turned to agree with their neighbours");
  return told;
}

std::vector<std::string> faults_told(const MeshFaults& faults, double unit)
{
  std::vector<std::string> told;
  const auto tell = [&](const MeshFaults::Kind& kind, const std::string& one, const std::string& many)
  {
    if (kind.count > 0)
      told.push_back(number(kind.count, one, many) + ", " + (kind.count > 1 ? "the first " : "") + "at " +
                     place_text(kind.place, unit));
  };
  tell(faults.touching, "edge where bodies touch (non-manifold)", "edges where bodies touch (non-manifold)");
  tell(faults.flat, "triangle without area", "triangles without area");
  tell(faults.slivers, "sliver", "slivers");
  if (faults.crossings.count > 0)
    told.push_back(number(faults.crossings.count, "pair", "pairs") + " of triangles cross, the widest group " +
                   length_text(faults.crossing_extent, unit) + " at " + place_text(faults.crossings.place, unit));
  if (!faults.holes.empty())
    told.push_back("is open: " + number(faults.holes.size(), "hole", "holes") + ", the largest " +
                   length_text(faults.holes.front().length, unit) + " around, at " +
                   place_text(faults.holes.front().centre, unit));
  return told;
}

}  // namespace

LoadedSurface load_surface(const Surface& surface, double unit)
{
  LoadedSurface loaded;
  TriangleMesh& mesh = loaded.mesh;
  if (surface.shape)
  {
    mesh = surface.shape->kind == Shape::Kind::forehead ? make_forehead(*surface.shape) : make_shape(*surface.shape);
    join_vertices(mesh);
    make_orientation_consistent(mesh);
    if (unbalanced_edges(mesh).empty() ? signed_volume(mesh) < 0 : open_and_inside_out(mesh))
      flip(mesh);
    return loaded;
  }
  mesh = import_mesh(surface.file, surface.unit);
  const Vector3 somewhere = mesh.vertices[static_cast<std::size_t>(mesh.triangles.front()[0])];
  const auto found = [&](const std::string& text)
  { loaded.findings.push_back("surface '" + surface.name + "': " + text); };

  const MeshRepairs repairs = repair_mesh(mesh);
  if (mesh.triangles.empty())
    throw Error("has no triangle with an area" +
                std::string(repairs.back_to_back > 0 ? " that does not lie back to back with another" : "") + ", at " +
                place_text(somewhere, unit) + " say; a surface that bounds something is wanted");
  for (const std::string& text : repairs_told(repairs))
    found(text);
  const MeshFaults faults = find_mesh_faults(mesh);
  const bool closed = unbalanced_edges(mesh).empty();
  if (closed)
  {
    std::size_t nested = 0;
    const std::size_t turned = turn_inside_out_pieces(mesh, faults.piece, nested);
    if (turned > 0)
      found(faults.crossing_piece.size() == 1 ? "was inside-out; turned"
                                              : number(turned, "piece", "pieces") + " inside-out; turned");
    if (nested > 0)
      found(number(nested, "piece lies", "pieces lie") + " inside another and face outwards: taken as solid there");
  }
  else if (open_and_inside_out(mesh))
  {
    flip(mesh);
    found("was inside-out; turned");
  }
  refuse(mesh, faults, closed, unit);
  for (const std::string& text : faults_told(faults, unit))
    found(text);
  return loaded;
}

}  // namespace frontalis
