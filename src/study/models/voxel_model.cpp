#include "frontalis/study/voxel_model.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace frontalis
{

double shear_modulus(double young, double poisson) { return young / (2 * (1 + poisson)); }
double bulk_modulus(double young, double poisson) { return young / (3 * (1 - 2 * poisson)); }

Material neo_hookean(double young, double poisson, double density)
{
  Material material;
  material.name = "neo_hookean";
  material.density = density;
  material.parameters[0] = shear_modulus(young, poisson);
  material.parameters[1] = bulk_modulus(young, poisson);
  return material;
}

Model voxel_model(const VoxelBox& box)
{
  Model model;
  model.size = box.size;
  model.spacing = box.spacing;
  model.materials = box.materials;
  model.mixture_begin.push_back(0);
  for (std::int32_t k = 0; k < box.size[2]; ++k)
    for (std::int32_t j = 0; j < box.size[1]; ++j)
      for (std::int32_t i = 0; i < box.size[0]; ++i)
      {
        const Voxel voxel{ { i, j, k } };
        const double fill = box.fill ? box.fill(voxel) : 1;
        if (!(fill > 0))
          continue;
        model.voxels.push_back(voxel);
        model.fill.push_back(static_cast<float>(fill));
        model.mixture_material.push_back(static_cast<std::int16_t>(box.material ? box.material(voxel) : 0));
        model.mixture_proportion.push_back(1);
        model.mixture_begin.push_back(static_cast<std::int32_t>(model.voxels.size()));
      }
  model.fibre_begin.assign(model.voxels.size() + 1, 0);
  build_nodes(model);
  return model;
}

Model voxel_model(const Voxel& size, double edge, const Material& material)
{
  return voxel_model(VoxelBox{ size, { { edge, edge, edge } }, { material } });
}

Model dense_block(std::int32_t x, std::int32_t y, std::int32_t z)
{
  Material tissue = neo_hookean(34e3, 0.49, 11000);
  tissue.name = "hypodermis";
  Model model = voxel_model({ { x, y, z } }, 1e-3, tissue);
  hold(model, [](const Point& p) { return p[0] == 0; });
  // With this gravity a block of any length is sheared by about 5 %: it moves but does not collapse.
  model.gravity = { { 0, 0, -0.05 * tissue.parameters[0] / (tissue.density * x * model.spacing[0]) } };
  return model;
}

std::function<double(const Voxel&)> sampled_fill(const Point& spacing, const Condition& inside, int samples,
                                                 double fill_min)
{
  return [=](const Voxel& voxel)
  {
    int count = 0;
    for (int k = 0; k < samples; ++k)
      for (int j = 0; j < samples; ++j)
        for (int i = 0; i < samples; ++i)
          count +=
              inside({ { (voxel[0] + (i + 0.5) / samples) * spacing[0], (voxel[1] + (j + 0.5) / samples) * spacing[1],
                         (voxel[2] + (k + 0.5) / samples) * spacing[2] } });
    const double fill = count / std::pow(samples, 3);
    return fill < fill_min ? 0 : fill;
  };
}

void mix(Model& model, const std::function<Mixture(std::size_t)>& mixture)
{
  model.mixture_begin.assign(1, 0);
  model.mixture_material.clear();
  model.mixture_proportion.clear();
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    for (const auto& [material, proportion] : mixture(e))
    {
      model.mixture_material.push_back(static_cast<std::int16_t>(material));
      model.mixture_proportion.push_back(proportion);
    }
    model.mixture_begin.push_back(static_cast<std::int32_t>(model.mixture_material.size()));
  }
}

void add_muscles(Model& model, const std::vector<Muscle>& muscles,
                 const std::function<std::vector<Fibre>(std::size_t)>& fibres)
{
  model.muscles = muscles;
  model.fibre_begin.assign(1, 0);
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    for (const Fibre& fibre : fibres(e))
    {
      model.fibre_muscle.push_back(static_cast<std::int16_t>(fibre.muscle));
      model.fibre_direction.push_back(fibre.direction);
      model.fibre_weight.push_back(fibre.weight);
    }
    model.fibre_begin.push_back(static_cast<std::int32_t>(model.fibre_muscle.size()));
  }
}

void add_muscle(Model& model, const Muscle& muscle, const std::function<std::array<float, 3>(std::size_t)>& direction)
{
  add_muscles(model, { muscle }, [&](std::size_t e) { return std::vector<Fibre>{ { 0, direction(e) } }; });
}

std::array<float, 3> along_x(std::size_t) { return { { 1, 0, 0 } }; }

Vectors affine_displacements(const Model& model, const std::array<double, 9>& gradient, const Point& shift)
{
  Vectors u(model.nodes.size(), shift);
  for (std::size_t n = 0; n < u.size(); ++n)
  {
    const auto p = rest_position(model, n);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        u[n][i] += (gradient[3 * i + j] - (i == j ? 1 : 0)) * p[j];
  }
  return u;
}

std::vector<std::int32_t> nodes_where(const Model& model, const Condition& condition)
{
  std::vector<std::int32_t> nodes;
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    if (condition(rest_position(model, n)))
      nodes.push_back(static_cast<std::int32_t>(n));
  return nodes;
}

void hold(Model& model, const Condition& condition, const std::string& bone)
{
  auto& bones = model.bones;
  const auto found = std::find(bones.begin(), bones.end(), bone);
  const auto index = bone.empty() ? -1 : static_cast<std::int32_t>(found - bones.begin());
  if (!bone.empty() && found == bones.end())
    bones.push_back(bone);
  for (const auto node : nodes_where(model, condition))
    model.rigid.push_back({ node, index });
}

void prescribe(Model& model, const std::vector<std::int32_t>& nodes, const std::array<bool, 3>& components,
               const Point& displacement, double ramp)
{
  Load load;
  load.name = fmt::format("prescribed {}", model.loads.size());
  load.kind = Load::Kind::displacement;
  load.value = displacement;
  load.fixed = components;
  load.ramp = ramp;
  for (const auto node : nodes)
    model.prescribed.push_back({ node, static_cast<std::int32_t>(model.loads.size()) });
  model.loads.push_back(load);
}

void hold_mirror_planes(Model& model)
{
  for (int axis = 0; axis < 3; ++axis)
    prescribe(model, nodes_where(model, [&](const auto& p) { return p[axis] == 0; }),
              { { axis == 0, axis == 1, axis == 2 } });
}

TriangleMesh grid_mesh(int rows, int columns, const std::function<Point(double, double)>& point)
{
  TriangleMesh mesh;
  for (int i = 0; i <= rows; ++i)
    for (int j = 0; j <= columns; ++j)
      mesh.vertices.push_back(point(static_cast<double>(i) / rows, static_cast<double>(j) / columns));
  const auto add = [&mesh](int a, int b, int c)
  {
    const auto apart = [&](int m, int n)
    {
      const auto &p = mesh.vertices[m], &q = mesh.vertices[n];
      return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]) > 1e-12;
    };
    if (apart(a, b) && apart(b, c) && apart(c, a))
      mesh.triangles.push_back({ { a, b, c } });
  };
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j)
    {
      const int corner = i * (columns + 1) + j, below = corner + columns + 1;
      add(corner, below, below + 1);
      add(corner, below + 1, corner + 1);
    }
  return mesh;
}

Binding bind_points(const Model& model, const Vectors& points)
{
  std::map<Voxel, std::size_t> index;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
    index[model.voxels[e]] = e;
  Binding binding;
  for (const Point& point : points)
  {
    // Searches the 5 x 5 x 5 grid cells around the point.
    double nearest = 1e300;
    std::size_t best = 0;
    for (int around = 0; around < 125; ++around)
    {
      Voxel at{ { around % 5 - 2, around / 5 % 5 - 2, around / 25 - 2 } };
      double squared = 0;
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        at[axis] += static_cast<std::int32_t>(std::floor(point[axis] / model.spacing[axis]));
        const double low = at[axis] * model.spacing[axis];
        const double outside = std::max({ low - point[axis], point[axis] - low - model.spacing[axis], 0.0 });
        squared += outside * outside;
      }
      if (const auto found = index.find(at); found != index.end() && squared < nearest)
      {
        nearest = squared;
        best = found->second;
      }
    }
    binding.voxel.push_back(static_cast<std::int32_t>(best));
    auto& coordinates = binding.coordinates.emplace_back();
    for (std::size_t axis = 0; axis < 3; ++axis)
      coordinates[axis] = static_cast<float>(point[axis] / model.spacing[axis] - model.voxels[best][axis]);
  }
  return binding;
}

void add_pressure(Model& model, double pressure, const TriangleMesh& mesh)
{
  Load load;
  load.name = "pressure";
  load.kind = Load::Kind::pressure;
  load.value[0] = pressure;
  load.mesh = mesh;
  load.binding = bind_points(model, mesh.vertices);
  model.loads.push_back(load);
}

}  // namespace frontalis
