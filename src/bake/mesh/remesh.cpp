#include "bake/mesh/remesh.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Surface_mesh.h>

namespace frontalis
{

// Ratio of the mean edge length to the length given to the algorithm, as measured on spheres.
constexpr double mean_over_target = 0.87;

TriangleMesh with_equal_edges(const TriangleMesh& mesh, double edge)
{
  namespace processing = CGAL::Polygon_mesh_processing;
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using HalfEdgeMesh = CGAL::Surface_mesh<Kernel::Point_3>;
  std::vector<Kernel::Point_3> points;
  points.reserve(mesh.vertices.size());
  for (const Vector3& v : mesh.vertices)
    points.emplace_back(v[0], v[1], v[2]);
  std::vector<std::array<std::size_t, 3>> triangles(mesh.triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    std::copy(mesh.triangles[t].begin(), mesh.triangles[t].end(), triangles[t].begin());
  // Each of several touching sheets gets its own vertices, as the half-edge structure requires.
  processing::orient_polygon_soup(points, triangles);
  HalfEdgeMesh surface;
  processing::polygon_soup_to_polygon_mesh(points, triangles, surface);
  processing::isotropic_remeshing(surface.faces(), edge / mean_over_target, surface,
                                  CGAL::parameters::number_of_iterations(5));
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

}  // namespace frontalis
