#pragma once

#include "frontalis/model/sample_field.hpp"

namespace frontalis
{

/// A model of nx by ny by nz voxels with at least one entry of every kind that a model can have.
inline Model full_block(std::int32_t nx, std::int32_t ny, std::int32_t nz)
{
  Model model;
  model.spacing = { 1e-3, 2e-3, 3e-3 };
  model.size = { nx, ny, nz };
  model.mixture_begin.push_back(0);
  model.fibre_begin.push_back(0);
  for (std::int32_t k = 0; k < nz; ++k)
  {
    for (std::int32_t j = 0; j < ny; ++j)
    {
      for (std::int32_t i = 0; i < nx; ++i)
      {
        model.voxels.push_back({ i, j, k });
        model.fill.push_back(i == 0 ? 0.5f : 1.f);
        model.mixture_material.insert(model.mixture_material.end(), { 0, 1 });
        model.mixture_proportion.insert(model.mixture_proportion.end(), { 0.25f, 0.75f });
        model.mixture_begin.push_back(static_cast<std::int32_t>(model.mixture_material.size()));
        model.material_directions.push_back({ 0.6f, 0, 0.8f, 0, 0, 0 });
        if (j == 0)
        {
          model.fibre_muscle.push_back(0);
          model.fibre_weight.push_back(0.5f);
          model.fibre_direction.push_back({ 0, 0.6f, 0.8f });
        }
        model.fibre_begin.push_back(static_cast<std::int32_t>(model.fibre_muscle.size()));
      }
    }
  }
  model.materials = { { "fat", Law::neo_hookean, { { 1e4, 5e5 } }, 1000, {}, {} },
                      { "a muscle", Law::neo_hookean, { { 2e5, 8e6 } }, 1060, { { 0.3, 0.1 } }, { { 0.1, 2 } } } };
  model.muscles = { { "frontalis_left", 5e6, true, false, 0.01, 0.03 } };
  model.hourglass = HourglassControl::assumed_strain;
  model.integration = Integration::selective_reduced;
  model.precision = Precision::compensated;
  model.time_step_estimate = TimeStepEstimate::assembled;
  build_nodes(model);

  const TriangleMesh triangle{ { { { 0, 0, 0 } }, { { 1e-3, 0, 0 } }, { { 0, 1e-3, 1e-9 } } }, { { { 0, 1, 2 } } } };
  const Binding binding{ { 0, 0, 0 }, { { { 0, 0, 0 } }, { { 1, 0, 0 } }, { { 0, 0.5f, -0.25f } } } };
  model.bones = { "skull", "mandible" };
  const SampledField sampled = sample_field(
      { { { 0, 0, 0 } } }, [](const auto& p) { return p[2] - 1e-3; }, 1e-3, 2e-3);
  model.constraint_surfaces = { { "skull", 1, 0.25, sampled } };
  model.rigid = { { 0, -1 }, { 1, 1 } };
  model.sliding = { { 2, 0, -0.00125 } };
  model.tissue_centre.assign(model.voxels.size(), { 0, 0.25F, -0.5F });
  model.attached = { { 4, 5, -0.25, 1, -1, -1 }, { 6, 5, 0.5, -1, 0, -1 } };
  model.gravity = { 0, 0, -9.81 };
  model.loads = {
    { "pull", Load::Kind::pressure, { { 1, 2, 3 } }, { { true, false, true } }, 0.5, 0, triangle, binding },
    { "push", Load::Kind::displacement, { { 0, 0, 1e-3 } }, { { false, false, true } }, 0, -1, {}, {} }
  };
  model.prescribed = { { 3, 1 } };
  model.skin = triangle;
  model.skin_binding = binding;
  model.landmarks = { "brow" };
  model.landmark_positions = { { 0.1e-3, 0.2e-3, 0.3e-3 } };
  model.landmark_binding = { { 0 }, { { { 0.1f, 0.1f, 0.1f } } } };
  model.to_scene = { { { 0, 0, 1, 1, 0, 0, 0, 1, 0 } }, { { 0.1, 0.2, 1.5 } } };
  model.to_face = { { { 0, 1, 0, 0, 0, 1, 1, 0, 0 } }, { { -0.1, 0, 0.3 } } };
  model.face_frame = "face_one";
  model.damping = 20;
  model.time_scaling = 2;
  model.frame_rate = 25;
  model.activation_slew = 8;
  model.time_step_share = 0.8;
  model.mass_scaling = { MassScalingSettings::Kind::selective, 1.5, { 1 }, 2e-5, 3e-5 };
  model.profiles = { { "draft", 0.3e-3, 0.8, "a bench" }, { "fine", 0, 0, "" } };
  model.profile = "draft";
  model.muscles[0].tone = 0.125;
  const Model::BonePose opened{ 1, { { 0, 0, -2e-3 } }, { { 0, 0.2, 0 } }, { { -80e-3, 0, -50e-3 } } };
  model.expressions = { { "raise", { { 0, 0.75f } } }, { "nothing", {} } };
  model.action_units = { { "AU1", { { 0, -0.5f } }, { opened } } };
  model.demo = { { 0, 0.2, 1.5 }, { -1, 0.3, 1, { { 1, { { 1e-3, 0, 0 } }, { { 0, 0.1, 0 } } } } } };
  model.scene_hash = "0123456789abcdef";
  return model;
}

}  // namespace frontalis
