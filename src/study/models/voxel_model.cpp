#include "frontalis/study/voxel_model.hpp"

#include <fmt/core.h>

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
        const std::array<std::int32_t, 3> voxel{ { i, j, k } };
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

Model voxel_model(const std::array<std::int32_t, 3>& size, double edge, const Material& material)
{
  return voxel_model(VoxelBox{ size, { { edge, edge, edge } }, { material }, {}, {} });
}

void add_muscle(Model& model, const Muscle& muscle, const std::function<std::array<float, 3>(std::size_t)>& direction)
{
  model.muscles = { muscle };
  model.fibre_begin.assign(1, 0);
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    model.fibre_direction.push_back(direction(e));
    model.fibre_begin.push_back(static_cast<std::int32_t>(e + 1));
  }
  model.fibre_muscle.assign(model.voxels.size(), 0);
  model.fibre_weight.assign(model.voxels.size(), 1);
}

Vectors affine_displacements(const Model& model, const std::array<double, 9>& gradient,
                             const std::array<double, 3>& shift)
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

std::vector<std::int32_t> nodes_where(const Model& model,
                                      const std::function<bool(const std::array<double, 3>&)>& condition)
{
  std::vector<std::int32_t> nodes;
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    if (condition(rest_position(model, n)))
      nodes.push_back(static_cast<std::int32_t>(n));
  return nodes;
}

void prescribe(Model& model, const std::vector<std::int32_t>& nodes, const std::array<bool, 3>& components,
               const std::array<double, 3>& displacement, double ramp)
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

}  // namespace frontalis
