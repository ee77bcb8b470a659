#pragma once

#include "frontalis/model/model.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>

namespace frontalis
{
namespace test
{

struct BlockSettings
{
  std::array<std::int32_t, 3> voxels{ { 4, 4, 4 } };
  std::array<double, 3> spacing{ { 1e-3, 1e-3, 1e-3 } };
  double young = 34e3;
  double poisson = 0.49;
  double density = 1000;
  double damping = 0;
  /// voxels for which this function returns false are left out
  std::function<bool(std::int32_t, std::int32_t, std::int32_t)> keep;
};

inline double shear_modulus(const BlockSettings& s) { return s.young / (2 * (1 + s.poisson)); }
inline double bulk_modulus(const BlockSettings& s) { return s.young / (3 * (1 - 2 * s.poisson)); }

/// A box of equal neo-Hookean voxels.
inline Model block_model(const BlockSettings& s = {})
{
  Model model;
  model.spacing = s.spacing;
  model.size = s.voxels;
  Material material;
  material.name = "tissue";
  material.density = s.density;
  material.parameters[0] = shear_modulus(s);
  material.parameters[1] = bulk_modulus(s);
  model.materials.push_back(material);
  model.mixture_begin.push_back(0);
  model.fibre_begin.push_back(0);
  for (std::int32_t k = 0; k < s.voxels[2]; ++k)
    for (std::int32_t j = 0; j < s.voxels[1]; ++j)
      for (std::int32_t i = 0; i < s.voxels[0]; ++i)
      {
        if (s.keep && !s.keep(i, j, k))
          continue;
        model.voxels.push_back({ { i, j, k } });
        model.fill.push_back(1);
        model.mixture_material.push_back(0);
        model.mixture_proportion.push_back(1);
        model.mixture_begin.push_back(static_cast<std::int32_t>(model.voxels.size()));
        model.fibre_begin.push_back(0);
      }
  build_nodes(model);
  model.damping = s.damping;
  return model;
}

/// Gives every voxel one muscle along a direction of length 1.
inline void add_muscle(Model& model, const std::array<float, 3>& direction, const Muscle& muscle)
{
  model.muscles.push_back(muscle);
  model.fibre_begin.assign(1, 0);
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    model.fibre_muscle.push_back(0);
    model.fibre_weight.push_back(1);
    model.fibre_direction.push_back(direction);
    model.fibre_begin.push_back(static_cast<std::int32_t>(e + 1));
  }
}

/// The nodes of a plane of the grid, which is normal to an axis.
inline std::vector<std::int32_t> plane_of_nodes(const Model& model, std::size_t axis, std::int32_t place = 0)
{
  std::vector<std::int32_t> nodes;
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    if (model.nodes[n][axis] == place)
      nodes.push_back(static_cast<std::int32_t>(n));
  return nodes;
}

/// Holds the nodes of such a plane.
inline void hold_plane(Model& model, std::size_t axis, std::int32_t bone = -1, std::int32_t place = 0)
{
  for (const auto node : plane_of_nodes(model, axis, place))
    model.rigid.push_back({ node, bone });
}

/// Rest position of a node [m].
inline std::array<double, 3> rest(const Model& model, std::size_t node) { return rest_position(model, node); }

}  // namespace test
}  // namespace frontalis
