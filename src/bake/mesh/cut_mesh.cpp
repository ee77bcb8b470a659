#include "bake/mesh/cut_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace frontalis
{
namespace
{

/// Keeps the part on one side of a plane: below `limit` along the axis for sign +1, above it for -1.
TriangleMesh cut(TriangleMesh mesh, std::size_t axis, double limit, double sign)
{
  const auto height = [&](std::int32_t v) { return sign * (limit - mesh.vertices[v][axis]); };
  std::map<std::array<std::int32_t, 2>, std::int32_t> crossings;
  const auto crossing = [&](std::int32_t a, std::int32_t b)
  {
    const auto found = crossings.insert({ { std::min(a, b), std::max(a, b) }, 0 });
    if (found.second)
    {
      // from the lower vertex number to the higher, so that both triangles of an edge get the same point to the bit
      const auto [p, q] = std::minmax(a, b);
      const double along = height(p) / (height(p) - height(q));
      const Vector3d from = vertex(mesh, p), to = vertex(mesh, q);
      Vector3d point = from + along * (to - from);
      point[axis] = limit;
      found.first->second = static_cast<std::int32_t>(mesh.vertices.size());
      mesh.vertices.push_back(to_array(point));
    }
    return found.first->second;
  };
  std::vector<Triangle> triangles;
  for (const Triangle& t : mesh.triangles)
  {
    std::vector<std::int32_t> polygon;
    for (std::size_t c = 0; c < 3; ++c)
    {
      const std::int32_t here = t[c], next = t[(c + 1) % 3];
      if (height(here) >= 0)
        polygon.push_back(here);
      if ((height(here) > 0 && height(next) < 0) || (height(here) < 0 && height(next) > 0))
        polygon.push_back(crossing(here, next));
    }
    for (std::size_t c = 2; c < polygon.size(); ++c)
      triangles.push_back({ polygon[0], polygon[c - 1], polygon[c] });
  }
  mesh.triangles = std::move(triangles);
  return mesh;
}

}  // namespace

TriangleMesh cut_mesh(const TriangleMesh& mesh, const Region& region)
{
  TriangleMesh part = mesh;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    if (std::isfinite(region.lower[axis]))
      part = cut(std::move(part), axis, region.lower[axis], -1);
    if (std::isfinite(region.upper[axis]))
      part = cut(std::move(part), axis, region.upper[axis], 1);
  }
  return keep_triangles(part, std::vector<bool>(part.triangles.size(), true));
}

}  // namespace frontalis
