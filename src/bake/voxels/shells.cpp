#include "bake/voxels/shells.hpp"

#include "bake/mesh/remesh.hpp"
#include "bake/messages.hpp"
#include "bake/voxels/contact_bodies.hpp"

#include <map>

namespace frontalis
{
namespace
{

// Length of edges over that of a voxel. At 1.2 a bent plate has 1 % too much energy, at 0.8 8 % and at 0.5 50 %; longer
// ones resolve short wrinkles less well (doc/wrinkles.md).
constexpr double edge_ratio = 1.2;

// Largest distance of a vertex from its voxel in voxel edges. Farther ones would have large weights, and shorten the
// time step.
constexpr double farthest = 1;

// moves vertices against their normals
void sink(TriangleMesh& mesh, double depth)
{
  std::vector<Vector3d> normals(mesh.vertices.size(), Vector3d(0, 0, 0));
  for (const Triangle& t : mesh.triangles)
  {
    const auto [a, b, c] = corners(mesh, t);
    for (const std::int32_t v : t)
      normals[v] += (b - a).cross(c - a);
  }
  for (std::size_t v = 0; v < normals.size(); ++v)
    mesh.vertices[v] = to_array(to_vector(mesh.vertices[v]) - depth * normals[v].normalized());
}

}  // namespace

void bind_shells(const Scene& scene, const PreparedSurfaces& surfaces, const LocalFrame& frame, Model& model,
                 BakeMonitor& monitor)
{
  const double edge = *std::max_element(model.spacing.begin(), model.spacing.end());
  std::map<std::pair<std::string, std::string>, double> depth;  // at which the next layer begins
  for (const Layer& layer : scene.layers)
  {
    double& top = depth[{ layer.volume, layer.surface }];
    const double middle = top + 0.5 * layer.thickness;
    top += layer.thickness;
    if (!layer.shell)
      continue;
    const std::string place = place_in_scene(scene, "layer", layer);
    const Region crop = scene.volumes[index_of(scene.volumes, layer.volume, place, "volume")].crop;
    // the part near the tissue: triangles of the surface itself may be larger than the tissue
    Box tissue;
    for (const auto& corner : { Vector3d(0, 0, 0), Vector3d(model.size[0], model.size[1], model.size[2]) })
      tissue.extend(frame.grid_point(model, corner[0], corner[1], corner[2]));
    BoundMesh near = bind_mesh(refined(named_surface(surfaces, layer.surface, place).mesh(), tissue, 2 * edge), crop,
                               frame, model, 2 * edge, monitor);
    TriangleMesh surface = near.mesh;
    if (!surface.triangles.empty())
      surface = with_equal_edges(surface, edge_ratio * edge);
    sink(surface, middle);
    for (Vector3& v : surface.vertices)
      v = to_array(frame.to_scene(to_vector(v)));
    BoundMesh bound = bind_mesh(surface, Region(), frame, model, farthest * edge, monitor);
    if (bound.mesh.triangles.empty())
      throw failure("{}: no triangle of surface '{}' lies in the crop of volume '{}' and within {} of its voxels",
                    place, layer.surface, layer.volume, length_text(farthest * edge, scene.unit));
    monitor.found("layer '{}': a shell of {} triangles, {:.4g} cm2", layer.name, bound.mesh.triangles.size(),
                  1e4 * surface_area(bound.mesh));
    model.shells.push_back({ layer.name, layer.thickness, index_of(scene.materials, layer.material, place, "material"),
                             std::move(bound.mesh), std::move(bound.binding) });
  }
}

}  // namespace frontalis
