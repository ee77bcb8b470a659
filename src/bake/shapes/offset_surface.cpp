#include "bake/mesh/surface.hpp"
#include "bake/messages.hpp"
#include "bake/shapes/isosurface.hpp"
#include "bake/shapes/radial_field.hpp"

#include <algorithm>

namespace frontalis
{

TriangleMesh make_offset(const Shape& shape, const TriangleMesh& above)
{
  const PreparedSurface surface("above", above);
  if (!surface.closed())
    throw Error("offset: the surface in 'below' has a border; it must be closed");
  std::vector<Vector3d> places;
  std::vector<double> depths;
  for (const auto& site : shape.depths)
  {
    const Vector3d place = surface.tree().closest(to_vector(site.at)).point;
    for (const Vector3d& earlier : places)
      if ((place - earlier).norm() < 1e-6)
        throw failure("offset: two of its depths are those of one place, number {} is the second", places.size() + 1);
    places.push_back(place);
    depths.push_back(site.depth);
  }
  const RadialField table(places, depths, RadialField::Polynomial::constant, 0);
  // Interpolated depths stay between the smallest and the largest depth of the table.
  const double least = *std::min_element(depths.begin(), depths.end());
  const double most = *std::max_element(depths.begin(), depths.end());
  const auto depth_at = [&](const Vector3d& p) { return std::clamp(table(p), least, most); };
  const auto f = [&](const Vector3d& p)
  {
    const ClosestPoint closest = surface.tree().closest(p);
    return surface.signed_distance(p, closest) + depth_at(closest.point);
  };
  // The depth jumps where the closest point does.
  TriangleMesh mesh = isosurface(f, surface.box(), shape.edge_or_default(), false, most - least);
  if (mesh.triangles.empty())
    throw failure("offset: no point is as deep as the depths ask for, {:.3g} to {:.3g} mm", 1e3 * least, 1e3 * most);
  return mesh;
}

}  // namespace frontalis
