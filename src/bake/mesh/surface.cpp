#include "bake/mesh/surface.hpp"

#include "frontalis/error.hpp"

#include <cmath>
#include <map>

namespace frontalis
{
namespace
{

double squared_distance_to_edge(const Vector3& p, const Vector3& a, const Vector3& b)
{
  const Vector3 ab = b - a;
  const double length = dot(ab, ab);
  const double t = length > 0 ? std::min(1.0, std::max(0.0, dot(p - a, ab) / length)) : 0;
  const Vector3 d = a + t * ab - p;
  return dot(d, d);
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
  // pseudonormals: faces, edges by the sum of their faces', vertices weighted by angle
  std::map<std::pair<std::int32_t, std::int32_t>, Vector3> edges;
  vertex_normals_.assign(mesh_.vertices.size(), { 0, 0, 0 });
  for (const Triangle& t : mesh_.triangles)
  {
    const Vector3* v[3];
    for (std::size_t c = 0; c < 3; ++c)
      v[c] = &mesh_.vertices[static_cast<std::size_t>(t[c])];
    const Vector3 normal = normalised(cross(*v[1] - *v[0], *v[2] - *v[0]));
    face_normals_.push_back(normal);
    for (std::size_t c = 0; c < 3; ++c)
    {
      const std::int32_t a = t[c], b = t[(c + 1) % 3];
      Vector3& edge = edges.emplace(std::make_pair(std::min(a, b), std::max(a, b)), Vector3{ 0, 0, 0 }).first->second;
      edge = edge + normal;
      const Vector3 e = normalised(*v[(c + 1) % 3] - *v[c]), f = normalised(*v[(c + 2) % 3] - *v[c]);
      const double angle = std::acos(std::max(-1.0, std::min(1.0, dot(e, f))));
      Vector3& vertex = vertex_normals_[static_cast<std::size_t>(a)];
      vertex = vertex + angle * normal;
    }
  }
  for (Vector3& normal : vertex_normals_)
    normal = normalised(normal);
  edge_normals_.reserve(mesh_.triangles.size());
  for (const Triangle& t : mesh_.triangles)
  {
    std::array<Vector3, 3> normals;
    for (std::size_t c = 0; c < 3; ++c)
      normals[c] = normalised(edges.at({ std::min(t[c], t[(c + 1) % 3]), std::max(t[c], t[(c + 1) % 3]) }));
    edge_normals_.push_back(normals);
  }
}

double PreparedSurface::winding_variation(const Vector3& p, double radius) const
{
  double sum = 0;
  for (const auto& edge : rim_)
  {
    const Vector3& a = mesh_.vertices[static_cast<std::size_t>(edge[0])];
    const Vector3& b = mesh_.vertices[static_cast<std::size_t>(edge[1])];
    const double distance = std::sqrt(squared_distance_to_edge(p, a, b)) - radius;
    if (distance <= 0)
      return 1e300;
    sum += norm(b - a) / (distance * distance);
  }
  return radius * sum / (4 * 3.14159265358979323846);
}

bool PreparedSurface::rim_within(const Vector3& p, double distance) const
{
  for (const auto& edge : rim_)
  {
    if (squared_distance_to_edge(p, mesh_.vertices[static_cast<std::size_t>(edge[0])],
                                 mesh_.vertices[static_cast<std::size_t>(edge[1])]) < distance * distance)
      return true;
  }
  return false;
}

const Vector3& PreparedSurface::pseudonormal(const ClosestPoint& closest) const
{
  const auto t = static_cast<std::size_t>(closest.triangle);
  if (closest.feature >= 4)
    return vertex_normals_[static_cast<std::size_t>(mesh_.triangles[t][static_cast<std::size_t>(closest.feature - 4)])];
  if (closest.feature >= 1)
    return edge_normals_[t][static_cast<std::size_t>(closest.feature - 1)];
  return face_normals_[t];
}

double PreparedSurface::signed_distance(const Vector3& p, const ClosestPoint& closest) const
{
  return dot(p - closest.point, pseudonormal(closest)) < 0 ? -closest.distance : closest.distance;
}

const PreparedSurface& named_surface(const std::vector<std::unique_ptr<PreparedSurface>>& surfaces,
                                     const std::string& name, const std::string& place)
{
  for (const auto& surface : surfaces)
  {
    if (surface->name() == name)
      return *surface;
  }
  throw Error(place + ": there is no surface '" + name + "'");
}

}  // namespace frontalis
