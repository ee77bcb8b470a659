#include "bake/mesh/remesh.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Constrained_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

namespace frontalis
{

namespace
{

namespace processing = CGAL::Polygon_mesh_processing;
namespace simplification = CGAL::Surface_mesh_simplification;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using HalfEdgeMesh = CGAL::Surface_mesh<Kernel::Point_3>;

// Ratio of the mean edge length to the length given to the algorithm, as measured on spheres.
constexpr double mean_over_target = 0.87;

// Each of several touching sheets gets its own vertices, as the half-edge structure requires.
HalfEdgeMesh to_half_edges(const TriangleMesh& mesh)
{
  std::vector<Kernel::Point_3> points;
  points.reserve(mesh.vertices.size());
  for (const Vector3& v : mesh.vertices)
    points.emplace_back(v[0], v[1], v[2]);
  std::vector<std::array<std::size_t, 3>> triangles(mesh.triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    std::copy(mesh.triangles[t].begin(), mesh.triangles[t].end(), triangles[t].begin());
  processing::orient_polygon_soup(points, triangles);
  HalfEdgeMesh surface;
  processing::polygon_soup_to_polygon_mesh(points, triangles, surface);
  return surface;
}

TriangleMesh to_triangles(HalfEdgeMesh& surface)
{
  surface.collect_garbage();
  TriangleMesh out;
  for (const auto v : surface.vertices())
    out.vertices.push_back({ surface.point(v).x(), surface.point(v).y(), surface.point(v).z() });
  for (const auto face : surface.faces())
  {
    Triangle t;
    std::size_t corner = 0;
    for (const auto v : CGAL::vertices_around_face(surface.halfedge(face), surface))
      t[corner++] = static_cast<std::int32_t>(v.idx());
    out.triangles.push_back(t);
  }
  return out;
}

// Property map of CGAL: whether an edge must stay.
struct Borders
{
  using key_type = HalfEdgeMesh::Edge_index;
  using value_type = bool;
  using reference = bool;
  using category = boost::readable_property_map_tag;

  const HalfEdgeMesh* surface;

  friend bool get(const Borders& borders, const key_type& edge) { return borders.surface->is_border(edge); }
};

}  // namespace

TriangleMesh with_equal_edges(const TriangleMesh& mesh, double edge)
{
  HalfEdgeMesh surface = to_half_edges(mesh);
  processing::isotropic_remeshing(surface.faces(), edge / mean_over_target, surface,
                                  CGAL::parameters::number_of_iterations(5));
  return to_triangles(surface);
}

TriangleMesh with_fewer_triangles(const TriangleMesh& mesh, double tolerance)
{
  using Policies = simplification::GarlandHeckbert_plane_policies<HalfEdgeMesh, Kernel>;
  HalfEdgeMesh surface = to_half_edges(mesh);
  const Policies policies(surface);
  const Borders borders{ &surface };
  // The cost of a vertex is the sum of its squared distances from planes.
  const auto is_too_far = [&](double cost, const auto&, std::size_t, std::size_t)
  { return cost > tolerance * tolerance; };
  simplification::edge_collapse(
      surface, is_too_far,
      CGAL::parameters::edge_is_constrained_map(borders)
          .get_cost(policies.get_cost())
          .get_placement(simplification::Constrained_placement<Policies::Get_placement, Borders>(
              borders, policies.get_placement()))
          .filter(simplification::Bounded_normal_change_filter<>()));
  return to_triangles(surface);
}

}  // namespace frontalis
