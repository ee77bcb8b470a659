#pragma once

#include "block_model.hpp"
#include "frontalis/runner/runner.hpp"

#include <chrono>
#include <memory>
#include <thread>

namespace frontalis
{
namespace test
{

/// A bar along x, fixed at x = 0, with one muscle along it. The skin is its free end.
inline std::shared_ptr<const Model> bar()
{
  BlockSettings s;
  s.voxels = { { 6, 2, 2 } };
  s.damping = 500;
  Model model = block_model(s);
  Muscle muscle;
  muscle.name = "puller";
  add_muscle(model, { { 1, 0, 0 } }, muscle);
  hold_plane(model, 0, 0);
  model.bones = { "jaw" };
  model.skin.vertices = { { { 6e-3, 0, 0 } }, { { 6e-3, 2e-3, 0 } }, { { 6e-3, 2e-3, 2e-3 } } };
  model.skin.triangles = { { { 0, 1, 2 } } };
  model.skin_binding.voxel = { 5, 11, 23 };
  model.skin_binding.coordinates = { { { 1, 0, 0 } }, { { 1, 1, 0 } }, { { 1, 1, 1 } } };
  model.landmarks = { "tip" };
  model.landmark_positions = { { { 6e-3, 0, 0 } } };
  model.landmark_binding.voxel = { 5 };
  model.landmark_binding.coordinates = { { { 1, 0, 0 } } };
  model.expressions.push_back({ "pull", { { 0, 0.8f } } });
  // local x is z of the face frame
  model.to_face.rotation = { { 0, 1, 0, 0, 0, 1, 1, 0, 0 } };
  model.to_face.translation = { { 0, 0, 1 } };
  return std::make_shared<const Model>(model);
}

inline RunnerSettings settings(Pace pace, double frame_rate = 100) { return { { "cpu", 1, 0 }, pace, frame_rate }; }

/// The bar with such a high time scaling that any machine can run it in real time.
inline std::shared_ptr<const Model> fast_bar()
{
  Model model = *bar();
  model.time_scaling = 100;
  return std::make_shared<const Model>(model);
}

/// Waits until a condition holds. Returns false if it does not hold within a minute.
template <typename Condition>
bool comes_true(const Condition& condition)
{
  for (const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1); !condition();
       std::this_thread::sleep_for(std::chrono::milliseconds(1)))
    if (std::chrono::steady_clock::now() > end)
      return false;
  return true;
}

}  // namespace test
}  // namespace frontalis
