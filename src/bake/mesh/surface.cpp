#include "bake/mesh/surface.hpp"

#include "frontalis/error.hpp"

#include <cmath>
#include <map>

namespace frontalis
{
namespace
{

double squared_distance_to_edge(const Vector3d& p, const Vector3d& a, const Vector3d& b)
{
  const Vector3d ab = b - a;
  const double length = ab.squaredNorm();
  const double t = length > 0 ? std::min(1.0, std::max(0.0, (p - a).dot(ab) / length)) : 0;
  return (a + t * ab - p).squaredNorm();
}

}  // namespace

PreparedSurface::PreparedSurface(std::string name, TriangleMesh mesh, int line)
    : name_(std::move(name)),
      mesh_(std::move(mesh)),
      line_(line),
      tree_(mesh_),
      box_(bounding_box(mesh_)),
      rim_(unbalanced_edges(mesh_))
{
  // an edge's pseudonormal is the sum of its faces' normals, a vertex's that weighted by the faces' angles
  std::map<std::pair<std::int32_t, std::int32_t>, Vector3d> edges;
  vertex_normals_.assign(mesh_.vertices.size(), Vector3d::Zero());
  for (const Triangle& t : mesh_.triangles)
  {
    const auto v = corners(mesh_, t);
    const Vector3d normal = (v[1] - v[0]).cross(v[2] - v[0]).normalized();
    face_normals_.push_back(normal);
    for (std::size_t c = 0; c < 3; ++c)
    {
      const std::int32_t a = t[c], b = t[(c + 1) % 3];
      Vector3d& edge = edges.emplace(std::minmax(a, b), Vector3d::Zero()).first->second;
      edge += normal;
      const Vector3d e = (v[(c + 1) % 3] - v[c]).normalized(), f = (v[(c + 2) % 3] - v[c]).normalized();
      const double angle = std::acos(std::max(-1.0, std::min(1.0, e.dot(f))));
      vertex_normals_[a] += angle * normal;
    }
  }
  for (Vector3d& normal : vertex_normals_)
    normal.normalize();
  edge_normals_.reserve(mesh_.triangles.size());
  for (const Triangle& t : mesh_.triangles)
  {
    std::array<Vector3d, 3> normals;
    for (std::size_t c = 0; c < 3; ++c)
      normals[c] = edges.at(std::minmax(t[c], t[(c + 1) % 3])).normalized();
    edge_normals_.push_back(normals);
  }
}

double PreparedSurface::winding_variation(const Vector3d& p, double radius) const
{
  double sum = 0;
  for (const auto& edge : rim_)
  {
    const Vector3d a = vertex(mesh_, edge[0]), b = vertex(mesh_, edge[1]);
    const double distance = std::sqrt(squared_distance_to_edge(p, a, b)) - radius;
    if (distance <= 0)
      return 1e300;
    sum += (b - a).norm() / (distance * distance);
  }
  return radius * sum / (4 * pi);
}

bool PreparedSurface::rim_within(const Vector3d& p, double distance) const
{
  for (const auto& edge : rim_)
    if (squared_distance_to_edge(p, vertex(mesh_, edge[0]), vertex(mesh_, edge[1])) < distance * distance)
      return true;
  return false;
}

const Vector3d& PreparedSurface::pseudonormal(const ClosestPoint& closest) const
{
  const std::int32_t t = closest.triangle;
  if (closest.feature >= 4)
    return vertex_normals_[mesh_.triangles[t][closest.feature - 4]];
  if (closest.feature >= 1)
    return edge_normals_[t][closest.feature - 1];
  return face_normals_[t];
}

double PreparedSurface::signed_distance(const Vector3d& p, const ClosestPoint& closest) const
{
  return (p - closest.point).dot(pseudonormal(closest)) < 0 ? -closest.distance : closest.distance;
}

const PreparedSurface& named_surface(const PreparedSurfaces& surfaces, const std::string& name,
                                     const std::string& place)
{
  for (const auto& surface : surfaces)
    if (surface->name() == name)
      return *surface;
  throw Error(place + ": there is no surface '" + name + "'");
}

}  // namespace frontalis
