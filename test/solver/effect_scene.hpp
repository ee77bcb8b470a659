#pragma once

#include "block_model.hpp"

#include "frontalis/model/sample_field.hpp"
#include "frontalis/physics/materials/all.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace test
{

/// Bits for the effects of a scene. Elasticity is always present.
enum SceneEffect : unsigned
{
  viscosity = 1,
  other_law = 2,
  contraction = 4,
  passive_fibres = 8,
  gravity = 16,
  pressure = 32,
  prescribed = 64,
  sliding = 128,
  friction = 256,  ///< friction, in addition to sliding
  loose = 512,     ///< the model has no rigid nodes
  but_friction = 255,
  everything = 511
};

inline std::vector<unsigned> every_combination()
{
  std::vector<unsigned> combinations;
  for (unsigned effects = 0; effects <= everything + loose; ++effects)
    if ((effects & sliding) != 0 || (effects & friction) == 0)
      combinations.push_back(effects);
  return combinations;
}

/// Height above the plane z = 0 [m].
inline double height(const std::array<double, 3>& p) { return p[2]; }

/// A model with the given effects, each in a part of its own. Rows of different lengths give full, half and empty
/// tiles.
inline Model scene_of(unsigned effects, HourglassControl hourglass = HourglassControl::scalar,
                      Integration integration = Integration::one_point)
{
  BlockSettings settings;
  settings.voxels = { { 11, 3, 3 } };
  settings.damping = 20;
  settings.keep = [](std::int32_t i, std::int32_t j, std::int32_t k) { return i < 11 - 2 * j || k == 1; };
  Model model = block_model(settings);
  model.hourglass = hourglass;
  model.integration = integration;
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    if (model.nodes[n][0] == 0 && !(effects & loose))
      model.rigid.push_back({ static_cast<std::int32_t>(n), -1 });
  if (effects & other_law)
  {
    Material other = model.materials[0];
    other.law = law_of<physics::MooneyRivlin>;
    other.parameters[0] /= 4;
    other.parameters[2] = other.parameters[0];
    model.materials.push_back(other);
  }
  if (effects & viscosity)
  {
    model.materials.back().viscous_share = { { 0.4, 0.2 } };
    model.materials.back().viscous_time = { { 2e-4, 1e-2 } };
  }
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
    if (model.voxels[e][0] > 6)
      model.mixture_material[e] = static_cast<std::int16_t>(model.materials.size() - 1);
  if (effects & (contraction | passive_fibres))
  {
    Muscle muscle;
    muscle.name = "strand";
    muscle.stress_reference = 20e3;
    muscle.passive = effects & passive_fibres;
    add_muscle(model, { { 0.8f, 0.6f, 0 } }, muscle);
    for (float& weight : model.fibre_weight)
      weight = 0.5f;
  }
  if (effects & gravity)
    model.gravity = { { 1, -2, 9.81 } };
  if (effects & pressure)
  {
    Load press;
    press.name = "press";
    press.kind = Load::Kind::pressure;
    press.value = { { 500, 0, 0 } };
    press.mesh.vertices = { { { 2e-3, 0, 3e-3 } }, { { 4e-3, 0, 3e-3 } }, { { 3e-3, 2e-3, 3e-3 } } };
    press.mesh.triangles = { { { 0, 1, 2 } } };
    for (const auto& corner : press.mesh.vertices)
      for (std::size_t e = 0; e < model.voxels.size(); ++e)
        if (model.voxels[e] == std::array<std::int32_t, 3>{ { static_cast<std::int32_t>(corner[0] * 1e3 + 0.5),
                                                              static_cast<std::int32_t>(corner[1] * 1e3 + 0.5), 2 } })
        {
          press.binding.voxel.push_back(static_cast<std::int32_t>(e));
          press.binding.coordinates.push_back({ { 0, 0, 1 } });
        }
    model.loads.push_back(press);
  }
  if (effects & prescribed)
  {
    Load pull;
    pull.name = "pull";
    pull.kind = Load::Kind::displacement;
    pull.value = { { 0, 3e-4, 0 } };
    pull.fixed = { { false, true, false } };
    pull.ramp = 1e-3;
    for (std::size_t n = 0; n < model.nodes.size(); ++n)
      if (model.nodes[n][0] == 11)
        model.prescribed.push_back({ static_cast<std::int32_t>(n), static_cast<std::int32_t>(model.loads.size()) });
    model.loads.push_back(pull);
  }
  if (effects & sliding)
  {
    std::vector<std::int32_t> underside;
    for (std::size_t n = 0; n < model.nodes.size(); ++n)
      if (model.nodes[n][2] == 0 && model.nodes[n][0] > 0 && model.nodes[n][0] < 9)
        underside.push_back(static_cast<std::int32_t>(n));
    slide_on(model, "floor", height, underside, 10e-3, 0.1);
    model.constraint_surfaces.back().friction = effects & friction ? 0.3 : 0;
  }
  return model;
}

using Vectors = std::vector<std::array<double, 3>>;

/// Largest difference of a component, divided by the largest component of b or, if that is larger, by 1 um.
inline double difference(const Vectors& a, const Vectors& b)
{
  double worst = 0, largest = 1e-6;
  for (std::size_t n = 0; n < a.size(); ++n)
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      worst = std::max(worst, std::abs(a[n][axis] - b[n][axis]));
      largest = std::max(largest, std::abs(b[n][axis]));
    }
  return worst / largest;
}

}  // namespace test
}  // namespace frontalis
