#include "bake/voxels/shells.hpp"

#include "bake/mesh/halve_edges.hpp"
#include "bake/mesh/remesh.hpp"
#include "bake/messages.hpp"
#include "frontalis/physics/hourglass.hpp"
#include "frontalis/physics/materials/lookup.hpp"

#include <cmath>
#include <map>

namespace frontalis
{
namespace
{

// Edge length of triangles divided by that of voxels. The energy of a bent plate is too large by 0.2 % at 1.2, 1 % at
// 0.8 and 33 % at 0.5. Longer edges resolve short wrinkles less well (doc/wrinkles.md).
constexpr double edge_ratio = 1.2;

// Largest distance of a vertex from its voxel, in voxel edges. Larger distances have large weights, which would shorten
// the time step.
constexpr double farthest = 1;

// Moves vertices against their normals.
void sink(TriangleMesh& mesh, double depth)
{
  const std::vector<Vector3d> normals = vertex_normals(mesh);
  for (std::size_t v = 0; v < normals.size(); ++v)
    mesh.vertices[v] = to_array(to_vector(mesh.vertices[v]) - depth * normals[v]);
}

// The mesh without the triangles that slits cut: a shell does not hold a cut closed.
TriangleMesh without_cut(const TriangleMesh& mesh, const std::vector<std::string>& slits,
                         const PreparedSurfaces& surfaces, const std::string& place)
{
  if (slits.empty())
    return mesh;
  std::vector<bool> keep(mesh.triangles.size(), true);
  for (const std::string& slit : slits)
  {
    const TriangleTree& tree = named_surface(surfaces, slit, place).tree();
    for (std::size_t t = 0; t < keep.size(); ++t)
    {
      const auto [a, b, c] = corners(mesh, mesh.triangles[t]);
      if (tree.crossed_by(a, b) || tree.crossed_by(b, c) || tree.crossed_by(c, a))
        keep[t] = false;
    }
  }
  return keep_triangles(mesh, keep);
}

// A stack of adjacent layers that are shells.
struct Plate
{
  const Layer* top = nullptr;
  std::string name;
  std::size_t layers = 0;
  int material = 0;  // material of the top layer
  double thickness = 0;
  // `stiffness` is the sum over the layers of Young's modulus times thickness. In the terms of the other sums, this
  // product is multiplied by the mean depth below the surface, the mean squared depth, or Poisson's ratio of the layer.
  double stiffness = 0, first = 0, second = 0, poisson = 0;

  void add(const Layer& layer, int index, const Material& of, double depth)
  {
    if (layers++ == 0)
    {
      top = &layer;
      material = index;
    }
    name += (name.empty() ? "" : " + ") + layer.name;
    thickness += layer.thickness;
    const double mu = physics::shear_modulus_of(of.law, of.parameters);
    const double young = physics::young_modulus(mu, of.parameters[1]), share = young * layer.thickness;
    const double middle = depth + 0.5 * layer.thickness;
    stiffness += share;
    first += share * middle;
    second += share * (middle * middle + layer.thickness * layer.thickness / 12);
    poisson += share * (young / (2 * mu) - 1);
  }
  double neutral() const { return first / stiffness; }

  // Replaces several layers by a homogeneous one with their membrane stiffness, and with their bending stiffness about
  // the common neutral surface. As separate shells each layer would bend about its own middle, and a thin stiff layer
  // would fold in waves that no voxel resolves.
  void make_homogeneous(Model& model)
  {
    if (layers == 1)
      return;
    thickness = std::sqrt(12 * (second / stiffness - neutral() * neutral()));
    const double young = stiffness / thickness, ratio = poisson / stiffness;
    Material together;
    together.name = name;
    together.density = model.materials[material].density;
    together.parameters[0] = young / (2 * (1 + ratio));
    together.parameters[1] = young / (3 * (1 - 2 * ratio));
    material = static_cast<int>(model.materials.size());
    model.materials.push_back(together);
  }
};

std::vector<Plate> plates_of(const Scene& scene, const Model& model)
{
  struct Below
  {
    double depth = 0;  // depth at which the next layer begins
    std::size_t plate = 0;
    bool on_plate = false;
  };
  std::map<std::pair<std::string, std::string>, Below> below;
  std::vector<Plate> plates;
  for (const Layer& layer : scene.layers)
  {
    Below& here = below[{ layer.volume, layer.surface }];
    if (layer.shell && !here.on_plate)
    {
      here.plate = plates.size();
      plates.emplace_back();
    }
    here.on_plate = layer.shell;
    if (layer.shell)
    {
      const int material = index_of(scene.materials, layer.material, place_in_scene(scene, "layer", layer), "material");
      plates[here.plate].add(layer, material, model.materials[material], here.depth);
    }
    here.depth += layer.thickness;
  }
  return plates;
}

}  // namespace

void bind_shells(const Scene& scene, const PreparedSurfaces& surfaces, const LocalFrame& frame, Model& model,
                 BakeMonitor& monitor)
{
  const double edge = *std::max_element(model.spacing.begin(), model.spacing.end());
  for (Plate& plate : plates_of(scene, model))
  {
    const Layer& layer = *plate.top;
    const std::string place = place_in_scene(scene, "layer", layer);
    const Volume& volume = scene.volumes[index_of(scene.volumes, layer.volume, place, "volume")];
    // Only the part near the tissue is used, because triangles of the surface may be larger than the tissue.
    const TriangleMesh& whole = named_surface(surfaces, layer.surface, place).mesh();
    BoundMesh near =
        bind_mesh(refined(whole, frame.grid_box(model), 2 * edge), volume.crop, frame, model, 2 * edge, monitor);
    TriangleMesh surface = near.mesh;
    if (!surface.triangles.empty())
      surface = with_equal_edges(surface, edge_ratio * edge);
    sink(surface, plate.neutral());
    for (Vector3& v : surface.vertices)
      v = to_array(frame.to_scene(to_vector(v)));
    surface = without_cut(surface, volume.slits, surfaces, place);
    BoundMesh bound = bind_mesh(surface, Region(), frame, model, farthest * edge, monitor);
    if (bound.mesh.triangles.empty())
      throw failure("{}: no triangle of surface '{}' lies in the crop of volume '{}' and within {} of its voxels",
                    place, layer.surface, layer.volume, length_text(farthest * edge, scene.unit));
    monitor.found("layer '{}': a shell of {} triangles, {:.4g} cm2", plate.name, bound.mesh.triangles.size(),
                  1e4 * surface_area(bound.mesh));
    plate.make_homogeneous(model);
    model.shells.push_back(
        { plate.name, plate.thickness, plate.material, std::move(bound.mesh), std::move(bound.binding) });
  }
}

}  // namespace frontalis
