#include "bake/mesh/mesh_faults.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <boost/pending/disjoint_sets.hpp>

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

namespace frontalis
{
namespace
{

namespace processing = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using HalfEdgeMesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Face = HalfEdgeMesh::Face_index;

constexpr double sliver_height = 0.02;  // largest height of a sliver divided by its longest edge
constexpr double least_spike = 2e-3;    // [m]
constexpr double spike_slope = 3;       // height of a spike divided by the longest edge around it; bones have up to 2

Vector3d vector_of(const Kernel::Point_3& p) { return { p.x(), p.y(), p.z() }; }

void add(MeshFaults::Kind& kind, const Vector3d& place)
{
  if (kind.count++ == 0)
    kind.place = place;
}

/// Edges as pairs of vertex indices, the lower one first.
using EdgeSet = std::set<std::pair<std::size_t, std::size_t>>;

/// Collects the edges that more than two triangles share.
struct EdgeCollector : processing::Default_orientation_visitor
{
  void non_manifold_edge(std::size_t a, std::size_t b, std::size_t) { edges->insert(std::minmax(a, b)); }
  EdgeSet* edges = nullptr;
};

HalfEdgeMesh half_edge_mesh(const TriangleMesh& mesh, EdgeSet& shared)
{
  std::vector<Kernel::Point_3> points;
  points.reserve(mesh.vertices.size());
  for (const Vector3& v : mesh.vertices)
    points.emplace_back(v[0], v[1], v[2]);
  std::vector<std::array<std::size_t, 3>> triangles(mesh.triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    std::copy(mesh.triangles[t].begin(), mesh.triangles[t].end(), triangles[t].begin());
  // Each of several touching bodies gets its own vertices, as the half-edge structure requires.
  EdgeCollector collector;
  collector.edges = &shared;
  processing::orient_polygon_soup(points, triangles, CGAL::parameters::visitor(collector));
  HalfEdgeMesh out;
  processing::polygon_soup_to_polygon_mesh(points, triangles, out);
  return out;
}

std::array<Vector3d, 3> corners_of(const HalfEdgeMesh& mesh, Face face)
{
  std::array<Vector3d, 3> places;
  std::size_t c = 0;
  for (const auto v : CGAL::vertices_around_face(mesh.halfedge(face), mesh))
    places[c++] = vector_of(mesh.point(v));
  return places;
}

void find_edge_faults(const TriangleMesh& mesh, const EdgeSet& shared, MeshFaults& faults)
{
  EdgeSet unbalanced;
  for (const auto& edge : unbalanced_edges(mesh))
    unbalanced.insert(std::minmax(edge[0], edge[1]));
  for (const auto& edge : shared)
  {
    const auto a = static_cast<std::int32_t>(edge.first), b = static_cast<std::int32_t>(edge.second);
    add(unbalanced.count(edge) != 0 ? faults.fins : faults.touching, 0.5 * (vertex(mesh, a) + vertex(mesh, b)));
  }
}

void find_thin_triangles(const HalfEdgeMesh& mesh, MeshFaults& faults)
{
  for (const Face face : mesh.faces())
  {
    const auto [a, b, c] = corners_of(mesh, face);
    const double longest = std::max({ (b - a).norm(), (c - b).norm(), (a - c).norm() });
    const double height = (b - a).cross(c - a).norm() / longest;
    const Vector3d middle = (1.0 / 3) * (a + b + c);
    if (CGAL::collinear(Kernel::Point_3(a[0], a[1], a[2]), Kernel::Point_3(b[0], b[1], b[2]),
                        Kernel::Point_3(c[0], c[1], c[2])))
      add(faults.flat, middle);
    else if (height < sliver_height * longest)
      add(faults.slivers, middle);
  }
}

// A spike is a vertex that is farther from the mean of its neighbours than these are apart.
void find_spikes(const HalfEdgeMesh& mesh, MeshFaults& faults)
{
  for (const auto v : mesh.vertices())
  {
    if (mesh.is_border(v))
      continue;
    Vector3d mean{ 0, 0, 0 };
    double around = 0;
    int count = 0;
    for (const auto edge : CGAL::halfedges_around_target(mesh.halfedge(v), mesh))
    {
      const Vector3d a = vector_of(mesh.point(mesh.source(edge)));
      mean += a;
      ++count;
      around = std::max(around, (vector_of(mesh.point(mesh.target(mesh.next(edge)))) - a).norm());
    }
    const Vector3d tip = vector_of(mesh.point(v));
    const double height = (tip - mean / std::max(1, count)).norm();
    if (height < least_spike || height < spike_slope * around)
      continue;
    ++faults.spikes.count;
    if (height > faults.spike_height)
    {
      faults.spike_height = height;
      faults.spikes.place = tip;
    }
  }
}

void find_pieces(HalfEdgeMesh& mesh, MeshFaults& faults)
{
  const auto piece = mesh.add_property_map<Face, std::size_t>("piece", 0).first;
  faults.crossing_piece.assign(processing::connected_components(mesh, piece), false);
  for (const Face face : mesh.faces())
    faults.piece.push_back(static_cast<std::int32_t>(piece[face]));
}

/// Whether two triangles only touch at corners, of which the half-edge structure has copies: where holes or bodies meet
/// in a corner or an edge. Also true for one triangle without area, which find_thin_triangles() reports.
bool only_touch(const HalfEdgeMesh& mesh, Face a, Face b)
{
  using Points = std::vector<Kernel::Point_3>;
  const auto points_of = [&mesh](Face face)
  {
    Points points;
    for (const auto v : CGAL::vertices_around_face(mesh.halfedge(face), mesh))
      points.push_back(mesh.point(v));
    return points;
  };
  // Turns the corners so that those which are no corners of the other triangle come last.
  const auto shared_first = [](Points& points, const Points& others)
  {
    const auto is_shared = [&](const Kernel::Point_3& p)
    { return std::find(others.begin(), others.end(), p) != others.end(); };
    return std::stable_partition(points.begin(), points.end(), is_shared) - points.begin();
  };
  Points of_a = points_of(a), of_b = points_of(b);
  const Points all_of_a = of_a;
  const auto shared = shared_first(of_a, of_b);
  shared_first(of_b, all_of_a);
  if (shared == 0)
    return false;
  if (shared == 1)
  {
    const auto crosses = [](const Points& edge, const Points& triangle)
    {
      return CGAL::do_intersect(Kernel::Segment_3(edge[1], edge[2]),
                                Kernel::Triangle_3(triangle[0], triangle[1], triangle[2]));
    };
    return !crosses(of_a, of_b) && !crosses(of_b, of_a);
  }
  // Two triangles with a common edge overlap only if they lie in one plane, on the same side of the edge.
  return shared == 3 || !CGAL::coplanar(of_a[0], of_a[1], of_a[2], of_b[2]) ||
         CGAL::coplanar_orientation(of_a[0], of_a[1], of_a[2], of_b[2]) == CGAL::NEGATIVE;
}

void find_crossings(const HalfEdgeMesh& mesh, MeshFaults& faults)
{
  std::vector<std::pair<Face, Face>> pairs;
  processing::self_intersections(mesh, std::back_inserter(pairs));
  // Bodies may overlap although their triangles only touch, where these meet in common edges.
  for (const auto& [a, b] : pairs)
    faults.crossing_piece[faults.piece[a]] = faults.crossing_piece[faults.piece[b]] = true;
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(),
                             [&](const auto& pair) { return only_touch(mesh, pair.first, pair.second); }),
              pairs.end());
  faults.crossings.count = pairs.size();
  if (pairs.empty())
    return;

  // Groups of crossing triangles, which are connected by crossings or common edges.
  boost::disjoint_sets_with_storage<> groups(mesh.number_of_faces());
  std::vector<bool> crosses(mesh.number_of_faces(), false);
  for (const auto& [a, b] : pairs)
  {
    crosses[a] = crosses[b] = true;
    groups.union_set(std::size_t{ a }, std::size_t{ b });
  }
  for (const Face face : mesh.faces())
    for (const auto edge : CGAL::halfedges_around_face(mesh.halfedge(face), mesh))
    {
      const Face other = mesh.face(mesh.opposite(edge));
      if (crosses[face] && other != HalfEdgeMesh::null_face() && crosses[other])
        groups.union_set(std::size_t{ face }, std::size_t{ other });
    }
  std::map<std::size_t, Box> boxes;
  for (const Face face : mesh.faces())
  {
    if (!crosses[face])
      continue;
    for (const Vector3d& corner : corners_of(mesh, face))
      boxes[groups.find_set(std::size_t{ face })].extend(corner);
  }
  for (const auto& [first, box] : boxes)
  {
    if (box.diagonal().norm() <= faults.crossing_extent)
      continue;
    faults.crossing_extent = box.diagonal().norm();
    faults.crossings.place = box.center();
  }
}

std::vector<MeshFaults::Hole> holes_of(const HalfEdgeMesh& mesh)
{
  std::vector<MeshFaults::Hole> holes;
  std::vector<HalfEdgeMesh::Halfedge_index> cycles;
  processing::extract_boundary_cycles(mesh, std::back_inserter(cycles));
  for (const auto cycle : cycles)
  {
    MeshFaults::Hole hole;
    for (const auto edge : CGAL::halfedges_around_face(cycle, mesh))
    {
      const Vector3d p = vector_of(mesh.point(mesh.source(edge))), q = vector_of(mesh.point(mesh.target(edge)));
      const double length = (q - p).norm();
      hole.length += length;
      hole.centre += (0.5 * length) * (p + q);
    }
    if (hole.length <= 0)
      continue;
    hole.centre /= hole.length;
    holes.push_back(hole);
  }
  std::stable_sort(holes.begin(), holes.end(),
                   [](const MeshFaults::Hole& a, const MeshFaults::Hole& b) { return a.length > b.length; });
  return holes;
}

}  // namespace

MeshFaults find_mesh_faults(const TriangleMesh& mesh)
{
  MeshFaults faults;
  EdgeSet shared;
  HalfEdgeMesh half_edges = half_edge_mesh(mesh, shared);
  find_edge_faults(mesh, shared, faults);
  find_thin_triangles(half_edges, faults);
  find_spikes(half_edges, faults);
  find_pieces(half_edges, faults);
  find_crossings(half_edges, faults);
  // Touching bodies were separated at their common edges. These edges are borders now, but not holes.
  if (!unbalanced_edges(mesh).empty())
    faults.holes = holes_of(half_edges);
  return faults;
}

std::vector<MeshFaults::Hole> find_holes(const TriangleMesh& mesh)
{
  EdgeSet shared;
  return holes_of(half_edge_mesh(mesh, shared));
}

}  // namespace frontalis
