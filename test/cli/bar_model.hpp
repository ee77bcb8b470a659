#pragma once

#include "frontalis/model/model.hpp"

#include <cstdint>

namespace frontalis
{

/// A soft bar of 8 x 2 x 2 voxels of 2 mm along local x, held at x = 0. The muscle `pull` runs along the bar, and the
/// landmark `tip` is in the middle of the free end. The face frame's z (up) is local x, its x (forward) is local y.
inline Model bar_model()
{
  constexpr double edge = 2e-3;
  Model model;
  model.spacing = { edge, edge, edge };
  model.size = { 8, 2, 2 };
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 8; ++i)
        model.voxels.push_back({ i, j, k });
  const std::size_t count = model.voxels.size();
  model.fill.assign(count, 1);

  Material flesh;
  flesh.name = "flesh";
  flesh.parameters = { 10e3, 100e3 };
  flesh.density = 1000;
  model.materials = { flesh };
  Muscle pull;
  pull.name = "pull";
  pull.stress_reference = 10e3;
  pull.tension_length = false;
  model.muscles = { pull };
  for (std::size_t e = 0; e <= count; ++e)
  {
    model.mixture_begin.push_back(static_cast<std::int32_t>(e));
    model.fibre_begin.push_back(static_cast<std::int32_t>(e));
  }
  model.mixture_material.assign(count, 0);
  model.mixture_proportion.assign(count, 1);
  model.fibre_muscle.assign(count, 0);
  model.fibre_weight.assign(count, 1);
  model.fibre_direction.assign(count, { 1, 0, 0 });
  build_nodes(model);
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    if (model.nodes[n][0] == 0)
      model.rigid.push_back({ static_cast<std::int32_t>(n), -1 });

  // the skin is the free end, bound to the last voxel of each row
  for (const std::int32_t row : { 0, 1, 2, 3 })
  {
    const int j = row % 2;
    const int k = row / 2;
    const double y = 2 * j * edge;
    const double z = 2 * k * edge;
    model.skin.vertices.push_back({ 8 * edge, y, z });
    model.skin_binding.voxel.push_back(8 * row + 7);
    model.skin_binding.coordinates.push_back({ 1, static_cast<float>(j), static_cast<float>(k) });
  }
  model.skin.triangles = { { 0, 1, 2 }, { 1, 3, 2 } };
  model.landmarks = { "tip" };
  model.landmark_positions = { { 8 * edge, edge, edge } };
  model.landmark_binding.voxel = { 7 };
  model.landmark_binding.coordinates = { { 1, 1, 1 } };

  model.to_face.rotation = { 0, 1, 0, 0, 0, 1, 1, 0, 0 };
  model.to_face.translation = { 0.5, 0.25, -0.125 };
  model.damping = 100;
  model.frame_rate = 50;
  model.expressions.push_back({ "shorten", { { 0, 0.5F } } });
  return model;
}

}  // namespace frontalis
