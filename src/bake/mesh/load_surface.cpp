#include "bake/mesh/surface.hpp"

#include "frontalis/bake/forehead_shape.hpp"
#include "bake/messages.hpp"
#include "bake/mesh/mesh_faults.hpp"
#include "bake/mesh/subdivide.hpp"
#include "bake/shapes/head/head.hpp"
#include "bake/shapes/muscle_net.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace frontalis
{
namespace
{

// Limits above which a surface is refused as self-intersecting: the fraction of the enclosed volume that is enclosed
// twice or inside-out; the depth of such a region divided by the surface's size; for an open surface, the extent of a
// group of crossing triangles divided by the surface's extent. Meshes segmented from images of a head reach 0.6 %, 1.7
// % and 1.8 %; surfaces that really overlap reach ten times as much (doc/baking.md).
constexpr double largest_overlap = 0.02;
constexpr double deepest_overlap = 0.04;
constexpr double widest_crossing = 0.05;
constexpr int overlap_samples = 10000;

/// Makes a shape of any kind.
TriangleMesh make_any(const Shape& shape, double unit)
{
  switch (shape.kind)
  {
    case Shape::Kind::forehead:
      return make_forehead(shape);
    case Shape::Kind::head:
      return make_head(shape);
    case Shape::Kind::muscle:
      return net_surface(curved_muscle_net(shape), shape.edge_or_default(), shape.thickness > 0);
    case Shape::Kind::offset:
      return make_offset(shape, load_surface(*shape.below, unit).mesh);
    default:
      return make_shape(shape);
  }
}

PolygonMesh polygons_of(const TriangleMesh& mesh)
{
  PolygonMesh polygons;
  polygons.group_names = { "default" };
  for (const Vector3& v : mesh.vertices)
    polygons.vertices.push_back(to_vector(v));
  for (const Triangle& t : mesh.triangles)
    polygons.faces.push_back({ t[0], t[1], t[2] });
  polygons.groups.assign(polygons.faces.size(), 0);
  return polygons;
}

/// Reads the surface of a mesh file. It is subdivided, if it is a control cage, and mirrored as the scene says.
TriangleMesh import_surface(const Surface& surface)
{
  if (surface.subdivide == 0 && surface.mirror < 0)
    return import_mesh(surface.file, surface.unit);
  PolygonMesh cage = surface.subdivide > 0 ? read_polygons(surface.file, surface.unit)
                                           : polygons_of(import_mesh(surface.file, surface.unit));
  if (surface.mirror >= 0)
    cage = with_mirror_image(cage, surface.mirror);
  constexpr double most_triangles = 2e7;  // the bake would take several minutes and 20 GB
  const double triangles = 2 * static_cast<double>(cage.faces.size()) * std::pow(4, surface.subdivide);
  if (surface.subdivide > 0 && triangles > most_triangles)
    throw failure(
        "'subdivide: {}' makes about {:.0f} million triangles of {} faces, at most {:.0f} million are allowed; "
        "give a smaller number",
        surface.subdivide, 1e-6 * triangles, cage.faces.size(), 1e-6 * most_triangles);
  return subdivide(cage, surface.subdivide);
}

/// Whether an open mesh is inside-out, that is, whether the winding number with the largest magnitude in its box is
/// negative. If the mesh has several pieces, no winding number may be clearly positive.
bool open_and_inside_out(const TriangleMesh& mesh, bool has_pieces = false)
{
  const TriangleTree tree(mesh);
  const Box box = bounding_box(mesh);
  double strongest = 0, largest = 0;
  for (int i = 0; i < 216; ++i)
  {
    const double w = tree.winding_number(spread_point(box, i));
    largest = std::max(largest, w);
    if (std::abs(w) > std::abs(strongest))
      strongest = w;
  }
  // Patches and domes have smaller winding numbers: they enclose too little for a decision.
  return strongest < -0.75 && !(has_pieces && largest > 0.75);
}

/// The triangles of one piece, with the vertices that they use.
TriangleMesh piece_of(const TriangleMesh& mesh, const std::vector<std::int32_t>& piece, std::int32_t number)
{
  TriangleMesh part;
  std::unordered_map<std::int32_t, std::int32_t> vertex_of;
  for (std::size_t t = 0; t < piece.size(); ++t)
    if (piece[t] == number)
    {
      Triangle& triangle = part.triangles.emplace_back(mesh.triangles[t]);
      for (std::int32_t& v : triangle)
      {
        const auto [entry, added] = vertex_of.emplace(v, static_cast<std::int32_t>(part.vertices.size()));
        if (added)
          part.vertices.push_back(mesh.vertices[v]);
        v = entry->second;
      }
    }
  return part;
}

/// Turns the pieces of an open mesh that are inside-out, and returns how many. Such a piece encloses points for which
/// its own winding number and that of the whole mesh are clearly negative; the wall of a cavity has a negative one by
/// itself only. Pieces with few triangles enclose little and are left alone, as are pieces inside of others.
std::size_t turn_pieces_of_open(TriangleMesh& mesh, const std::vector<std::int32_t>& piece)
{
  constexpr std::size_t least_triangles = 100;
  std::vector<std::size_t> triangles(1 + *std::max_element(piece.begin(), piece.end()), 0);
  for (const std::int32_t p : piece)
    ++triangles[p];
  const TriangleTree whole(mesh);
  std::vector<bool> turn(triangles.size(), false);
  for (std::size_t p = 0; p < turn.size(); ++p)
    if (triangles[p] >= least_triangles)
    {
      const TriangleMesh part = piece_of(mesh, piece, static_cast<std::int32_t>(p));
      const TriangleTree tree(part);
      const Box box = bounding_box(part);
      for (int i = 0; i < 216 && !turn[p]; ++i)
      {
        const Vector3d place = spread_point(box, i);
        turn[p] = tree.winding_number(place) < -0.75 && whole.winding_number(place) < -0.75;
      }
    }
  for (std::size_t t = 0; t < piece.size(); ++t)
    if (turn[piece[t]])
      std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  return static_cast<std::size_t>(std::count(turn.begin(), turn.end(), true));
}

/// Regions that a mesh encloses twice or inside-out. Only components of the mesh with crossing triangles are examined.
struct Overlap
{
  double share = 0;  ///< volume of these regions divided by the whole enclosed volume
  double depth = 0;  ///< largest distance of a point of these regions from the surface [m]
  double size = 0;   ///< cube root of the volume that the pieces enclose [m]
  Vector3d deepest{ 0, 0, 0 };
};

Overlap find_overlap(const TriangleMesh& mesh, const MeshFaults& faults)
{
  std::vector<bool> keep(mesh.triangles.size());
  for (std::size_t t = 0; t < keep.size(); ++t)
    keep[t] = faults.crossing_piece[faults.piece[t]];
  const TriangleMesh pieces = keep_triangles(mesh, keep);
  const TriangleTree tree(pieces);
  const Box box = bounding_box(pieces);
  Overlap overlap;
  int enclosed = 0, wrong = 0;
  for (int i = 0; i < overlap_samples; ++i)
  {
    const Vector3d p = spread_point(box, i);
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
  overlap.size = std::cbrt(box.volume() * enclosed / overlap_samples);
  return overlap;
}

/// Throws Error if a fault makes it unclear what the surface encloses.
void refuse_faults(const TriangleMesh& mesh, const MeshFaults& faults, bool closed, double unit)
{
  if (faults.fins.count > 0)
    throw failure(
        "at {} an odd number of triangles meet (non-manifold), the first at {}: it is undefined which side is inside; "
        "delete the surplus triangles in a modelling tool",
        count_text(faults.fins.count, "edge", "edges"), place_text(faults.fins.place, unit));
  if (closed && std::abs(signed_volume(mesh)) < 1e-7 * std::pow(surface_area(mesh), 1.5))
    throw failure(
        "is closed but encloses nothing: it has no thickness at {}; give it one, or use an open sheet that bounds a "
        "volume together with others",
        place_text(bounding_box(mesh).center(), unit));
  const auto& crossing = faults.crossing_piece;
  if (std::find(crossing.begin(), crossing.end(), true) == crossing.end())
    return;

  const Overlap overlap = find_overlap(mesh, faults);
  const std::string fault = faults.crossings.count == 0
                                ? "passes through itself along common edges of its parts, "
                                : fmt::format("passes through itself: {} of triangles cross, ",
                                              count_text(faults.crossings.count, "pair", "pairs"));
  if (overlap.share > largest_overlap || overlap.depth > deepest_overlap * overlap.size)
    throw failure(
        "{}and {:.2g} % of what it encloses is enclosed twice or from outside, deepest ({}) at {}; unite the parts in "
        "a modelling tool, or give each a file and a surface of its own",
        fault, 100 * overlap.share, length_text(overlap.depth, unit), place_text(overlap.deepest, unit));
  if (!closed && faults.crossing_extent > widest_crossing * bounding_box(mesh).diagonal().norm())
    throw failure(
        "{}over {} around {}; delete one of the sheets in a modelling tool, or give each a file and a surface of "
        "its own",
        fault, length_text(faults.crossing_extent, unit), place_text(faults.crossings.place, unit));
}

using Found = std::function<void(const std::string& sentence)>;

void describe(const MeshRepairs& repairs, const Found& found)
{
  const auto add = [&found](std::size_t count, const char* one, const char* many)
  {
    if (count > 0)
      found(count_text(count, one, many));
  };
  add(repairs.collapsed, "triangle with a corner twice left out", "triangles with a corner twice left out");
  add(repairs.repeated, "repeated triangle left out", "repeated triangles left out");
  add(repairs.back_to_back, "pair of triangles back to back left out", "pairs of triangles back to back left out");
  add(repairs.flat, "triangle without area left out", "triangles without area left out");
  add(repairs.turned, "triangle turned to agree with its neighbours",
      "triangles turned to agree with their neighbours");
}

void describe(const MeshFaults& faults, double unit, const Found& found)
{
  const auto add = [&](const MeshFaults::Kind& kind, const char* one, const char* many)
  {
    if (kind.count > 0)
      found(fmt::format("{}, {}at {}", count_text(kind.count, one, many), kind.count > 1 ? "the first " : "",
                        place_text(kind.place, unit)));
  };
  add(faults.touching, "edge where bodies touch (non-manifold)", "edges where bodies touch (non-manifold)");
  add(faults.flat, "triangle without area", "triangles without area");
  add(faults.slivers, "sliver", "slivers");
  if (faults.crossings.count > 0)
    found(fmt::format("{} of triangles cross, the widest group {} at {}",
                      count_text(faults.crossings.count, "pair", "pairs"), length_text(faults.crossing_extent, unit),
                      place_text(faults.crossings.place, unit)));
  if (faults.holes.empty())
    return;
  // The largest one is often where a head ends, at the neck; those that matter are smaller.
  constexpr std::size_t most_told = 6;
  const auto hole_text = [&](const MeshFaults::Hole& hole)
  { return fmt::format("{} around, at {}", length_text(hole.length, unit), place_text(hole.centre, unit)); };
  std::string text = fmt::format("is open: {}, the largest {}", count_text(faults.holes.size(), "hole", "holes"),
                                 hole_text(faults.holes.front()));
  for (std::size_t h = 1; h < std::min(most_told, faults.holes.size()); ++h)
    text += "; " + hole_text(faults.holes[h]);
  found(text);
}

/// What to say of small pieces that lie apart from the others, or that enclose again what the others enclose, such as
/// those that a segmentation leaves; empty without.
std::string stray_pieces(const TriangleMesh& mesh, const std::vector<std::int32_t>& piece, double unit)
{
  constexpr double small = 0.01;          // share of the area
  constexpr double apart = 0.1;           // distance from the box around the other pieces, in diagonals of this box
  constexpr double enclosed_again = 1.4;  // winding number in a piece; that around it is less than 1 in an open surface
  struct Piece
  {
    double area = 0;
    Box box;
  };
  std::vector<Piece> pieces(1 + *std::max_element(piece.begin(), piece.end()));
  const double whole = surface_area(mesh);
  for (std::size_t t = 0; t < piece.size(); ++t)
  {
    const auto [a, b, c] = corners(mesh, mesh.triangles[t]);
    Piece& of = pieces[piece[t]];
    for (const Vector3d& p : { a, b, c })
      of.box.extend(p);
    of.area += 0.5 * (b - a).cross(c - a).norm();
  }
  Box large;
  for (const Piece& of : pieces)
    if (of.area >= small * whole)
      large.extend(of.box);
  if (large.isEmpty())  // no piece is large
    return {};
  std::optional<TriangleTree> tree;
  const auto strays = [&](const Piece& of)
  {
    if (of.area >= small * whole)
      return false;
    if (large.exteriorDistance(of.box.center()) > apart * large.diagonal().norm())
      return true;
    if (!tree)
      tree.emplace(mesh);
    return std::abs(tree->winding_number(of.box.center())) > enclosed_again;  // the mesh may be inside-out
  };
  const auto count = static_cast<std::size_t>(std::count_if(pieces.begin(), pieces.end(), strays));
  if (count == 0)
    return {};
  const Piece& first = *std::find_if(pieces.begin(), pieces.end(), strays);
  return fmt::format(
      "has {} of less than a hundredth of its area apart from the others or inside of them, {}at {}: remove what does "
      "not belong to it",
      count_text(count, "piece", "pieces"), count > 1 ? "one " : "", place_text(first.box.center(), unit));
}

}  // namespace

LoadedSurface load_surface(const Surface& surface, double unit)
{
  LoadedSurface loaded;
  TriangleMesh& mesh = loaded.mesh;
  if (surface.shape)
  {
    mesh = make_any(*surface.shape, unit);
    join_vertices(mesh);
    make_orientation_consistent(mesh);
    // The lining of a head's mouth faces out of the tissue, into the mouth, and would be taken to be inside out.
    const bool closed = unbalanced_edges(mesh).empty();
    const bool oriented = surface.shape->kind == Shape::Kind::head && surface.shape->part == "mucosa";
    if (closed ? signed_volume(mesh) < 0 : !oriented && open_and_inside_out(mesh))
      flip(mesh);
    return loaded;
  }
  mesh = import_surface(surface);
  const Vector3d first_corner = vertex(mesh, mesh.triangles.front()[0]);
  const auto found = [&](const std::string& text)
  { loaded.findings.push_back(fmt::format("surface '{}': {}", surface.name, text)); };

  const MeshRepairs repairs = repair_mesh(mesh);
  if (mesh.triangles.empty())
    throw failure("has no triangle with an area{}, for example at {}; it must be a surface that bounds something",
                  repairs.back_to_back > 0 ? " that does not lie back to back with another" : "",
                  place_text(first_corner, unit));
  describe(repairs, found);
  const MeshFaults faults = find_mesh_faults(mesh);
  if (const std::string strays = stray_pieces(mesh, faults.piece, unit); !strays.empty())
    loaded.warnings.push_back(fmt::format("surface '{}' {}", surface.name, strays));
  if (faults.spikes.count > 0)
    loaded.warnings.push_back(fmt::format("surface '{}' has {}, the highest by {} at {}: remove such vertices",
                                          surface.name, count_text(faults.spikes.count, "spike", "spikes"),
                                          length_text(faults.spike_height, unit),
                                          place_text(faults.spikes.place, unit)));
  const bool closed = unbalanced_edges(mesh).empty();
  std::size_t nested = 0, turned = 0;
  if (closed)
    turned = turn_inside_out_pieces(mesh, faults.piece, nested);
  const std::size_t pieces = faults.crossing_piece.size();
  if (!closed && open_and_inside_out(mesh, pieces > 1))
  {
    flip(mesh);
    found("was inside-out; turned");
  }
  if (!closed && pieces > 1)
    turned = turn_pieces_of_open(mesh, faults.piece);
  if (turned > 0)
    found(pieces == 1 ? "was inside-out; turned" : count_text(turned, "piece", "pieces") + " inside-out; turned");
  if (nested > 0)
    found(count_text(nested, "piece lies", "pieces lie") + " inside another and face outwards: taken as solid there");
  try
  {
    refuse_faults(mesh, faults, closed, unit);
  }
  catch (const Error& error)
  {
    std::string text = error.what();
    for (const std::string& warning : loaded.warnings)
      text += "; " + warning;
    throw Error(text);
  }
  describe(faults, unit, found);
  return loaded;
}

}  // namespace frontalis
