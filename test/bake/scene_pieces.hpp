#pragma once

#include "bake/vector.hpp"
#include "frontalis/bake/bake.hpp"

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

namespace frontalis
{

inline Surface box_surface(const std::string& name, const Vector3& centre, const Vector3& size, double edge = 0)
{
  Surface surface;
  surface.name = name;
  surface.shape = Shape();
  surface.shape->kind = Shape::Kind::box;
  surface.shape->centre = centre;
  surface.shape->size = size;
  surface.shape->edge = edge;
  return surface;
}

inline Surface sphere_surface(const std::string& name, const Vector3& centre, double radius, double edge = 0)
{
  Surface surface;
  surface.name = name;
  surface.shape = Shape();
  surface.shape->kind = Shape::Kind::sphere;
  surface.shape->centre = centre;
  surface.shape->radius = radius;
  surface.shape->edge = edge;
  return surface;
}

inline Surface file_surface(const std::string& name, const std::string& file, double unit = 1)
{
  Surface surface;
  surface.name = name;
  surface.file = file;
  surface.unit = unit;
  return surface;
}

/// Writes an OBJ file of the triangles that `keep` accepts.
template <class Keep>
void write_obj(const TriangleMesh& mesh, const std::string& path, const Keep& keep)
{
  std::ofstream out(path);
  out.precision(9);
  for (const Vector3& v : mesh.vertices)
    out << "v " << v[0] << " " << v[1] << " " << v[2] << "\n";
  for (const auto& t : mesh.triangles)
  {
    if (keep(t))
      out << "f " << t[0] + 1 << " " << t[1] + 1 << " " << t[2] + 1 << "\n";
  }
}

inline Surface forehead_surface(const std::string& part)
{
  Surface surface;
  surface.name = part;
  surface.shape = Shape();
  surface.shape->kind = Shape::Kind::forehead;
  surface.shape->part = part;
  return surface;
}

inline Volume volume_inside(const std::string& name, const std::vector<std::string>& inside,
                            const std::string& material, bool tissue, int priority = 0)
{
  Volume volume;
  volume.name = name;
  volume.inside = inside;
  volume.material = material;
  volume.tissue = tissue;
  volume.priority = priority;
  return volume;
}

inline SceneMaterial material(const std::string& name, double young = 1e5)
{
  SceneMaterial material;
  material.name = name;
  material.density = 1000;
  material.parameters = { { "young", young }, { "poisson", 0.49 } };
  return material;
}

/// A scene with materials fat, dermis and muscle and voxels of the given edge. Nearly empty voxels are kept.
inline Scene plain_scene(double voxel)
{
  Scene scene;
  scene.file = "test.yaml";
  scene.materials = { material("fat"), material("dermis"), material("muscle") };
  scene.accuracy.voxel = { voxel, voxel, voxel };
  scene.accuracy.fill_min = 0;
  return scene;
}

inline double voxel_volume(const Model& model) { return model.spacing[0] * model.spacing[1] * model.spacing[2]; }

/// Volume of the model's tissue, or of one material in it [m3].
inline double tissue_volume(const Model& model, const std::string& material = "")
{
  double sum = 0;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    for (auto m = static_cast<std::size_t>(model.mixture_begin[e]);
         m < static_cast<std::size_t>(model.mixture_begin[e + 1]); ++m)
    {
      if (material.empty() || model.materials[static_cast<std::size_t>(model.mixture_material[m])].name == material)
        sum += static_cast<double>(model.fill[e]) * static_cast<double>(model.mixture_proportion[m]);
    }
  }
  return sum * voxel_volume(model);
}

/// Volume of a muscle [m3].
inline double muscle_volume(const Model& model, int muscle)
{
  double sum = 0;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    for (auto m = static_cast<std::size_t>(model.fibre_begin[e]);
         m < static_cast<std::size_t>(model.fibre_begin[e + 1]); ++m)
    {
      if (model.fibre_muscle[m] == muscle)
        sum += static_cast<double>(model.fill[e]) * static_cast<double>(model.fibre_weight[m]);
    }
  }
  return sum * voxel_volume(model);
}

inline Vector3 transformed(const RigidTransform& t, const Vector3& p)
{
  Vector3 out = t.translation;
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c)
      out[r] += t.rotation[3 * r + c] * p[c];
  return out;
}

inline Vector3 node_position(const Model& model, std::int32_t node)
{
  const auto& n = model.nodes[static_cast<std::size_t>(node)];
  return { n[0] * model.spacing[0], n[1] * model.spacing[1], n[2] * model.spacing[2] };
}

/// Trilinear interpolation of a nodal field at a bound point.
template <class Field>
Vector3 interpolated(const Model& model, const Binding& binding, std::size_t point, const Field& field)
{
  Vector3 sum{ 0, 0, 0 };
  const auto& nodes = model.voxel_nodes[static_cast<std::size_t>(binding.voxel[point])];
  for (std::size_t b = 0; b < 8; ++b)
  {
    double weight = 1;
    for (std::size_t a = 0; a < 3; ++a)
    {
      const auto c = static_cast<double>(binding.coordinates[point][a]);
      weight *= (b >> a & 1) != 0 ? c : 1 - c;
    }
    const Vector3 value = field(node_position(model, nodes[b]));
    for (std::size_t a = 0; a < 3; ++a)
      sum[a] += weight * value[a];
  }
  return sum;
}

inline std::string fault_of(const Scene& scene)
{
  try
  {
    bake(scene);
  }
  catch (const std::exception& error)
  {
    return error.what();
  }
  return "";
}

}  // namespace frontalis
