#include "bake/voxels/self_contacts.hpp"

#include "bake/mesh/halve_edges.hpp"
#include "bake/messages.hpp"
#include "bake/voxels/voxel_index.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

// Distance from a triangle, on both sides, at which tissue is looked for, in longest voxel edges.
constexpr double search_distance = 0.75;

// Smallest magnitude of area_behind() of a surface that is a boundary of the tissue.
constexpr double least_agreement = 0.2;

// The area with tissue behind it minus the area with tissue in front of it, divided by the area with tissue on a side.
double area_behind(const TriangleMesh& mesh, const LocalFrame& frame, const Model& model, const VoxelIndex& voxels)
{
  const Vector3d spacing = to_vector(model.spacing);
  const auto has_tissue = [&](const Vector3d& p)
  {
    const Vector3d cell = p.cwiseQuotient(spacing).array().floor();
    return voxels.find({ { static_cast<std::int32_t>(cell[0]), static_cast<std::int32_t>(cell[1]),
                           static_cast<std::int32_t>(cell[2]) } }) >= 0;
  };
  double behind = 0, all = 0;
  for (const Triangle& t : mesh.triangles)
  {
    const auto [a, b, c] = corners(mesh, t);
    const Vector3d normal = (b - a).cross(c - a), centre = frame.to_local(Vector3d((a + b + c) / 3));
    const double area = 0.5 * normal.norm();
    const Vector3d step = frame.turn(normal) * (search_distance * spacing.maxCoeff() / std::max(normal.norm(), 1e-30));
    const bool is_behind = has_tissue(centre - step), is_in_front = has_tissue(centre + step);
    behind += area * (int(is_behind) - int(is_in_front));
    all += is_behind || is_in_front ? area : 0;
  }
  return all > 0 ? behind / all : 0;
}

}  // namespace

void bind_self_contacts(const Scene& scene, const PreparedSurfaces& surfaces, const LocalFrame& frame, Model& model,
                        BakeMonitor& monitor)
{
  const double extrapolation = extrapolation_of(scene, model);
  const VoxelIndex voxels(model);
  for (const SceneConstraint& constraint : scene.constraints)
  {
    if (constraint.kind != SceneConstraint::Kind::self_contact)
      continue;
    const std::string place = place_in_scene(scene, "constraint", constraint);
    TriangleMesh all;
    for (const std::string& name : constraint.surfaces)
    {
      TriangleMesh surface = refined(named_surface(surfaces, name, place).mesh(), to_box(constraint.crop),
                                     *std::min_element(model.spacing.begin(), model.spacing.end()));
      const BoundMesh bound = bind_mesh(surface, constraint.crop, frame, model, extrapolation, monitor);
      if (bound.mesh.triangles.empty())
        throw failure("{}: no triangle of surface '{}' lies in its crop and within {} of the tissue; check the crop",
                      place, name, length_text(extrapolation, scene.unit));
      if (bound.too_far > 0)
        monitor.found("constraint '{}': {} triangles of '{}' left out, too far from the tissue", constraint.name,
                      bound.too_far, name);
      const double behind = area_behind(cut_mesh(surface, constraint.crop), frame, model, voxels);
      if (std::abs(behind) < least_agreement)
        throw failure(
            "{}: surface '{}' has as much tissue in front of it as behind it, so that it has no outer side that could "
            "touch; only boundaries of the tissue can",
            place, name);
      const auto first = static_cast<std::int32_t>(all.vertices.size());
      all.vertices.insert(all.vertices.end(), surface.vertices.begin(), surface.vertices.end());
      for (const Triangle& t : surface.triangles)
        all.triangles.push_back(behind > 0 ? Triangle{ first + t[0], first + t[1], first + t[2] }
                                           : Triangle{ first + t[0], first + t[2], first + t[1] });
    }
    join_vertices(all);
    BoundMesh bound = bind_mesh(all, constraint.crop, frame, model, extrapolation, monitor);
    model.self_contacts.push_back(
        { constraint.name, constraint.friction, std::move(bound.mesh), std::move(bound.binding) });
  }
}

}  // namespace frontalis
