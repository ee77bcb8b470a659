#pragma once

#include "frontalis/model/model.hpp"
#include "frontalis/scene/scene.hpp"

#include <functional>
#include <string>
#include <vector>

namespace frontalis
{

struct BakeReport
{
  struct Stage
  {
    std::string name;
    double seconds = 0;
  };
  std::vector<Stage> stages;
  std::vector<std::string> findings;  ///< what was repaired, clipped, removed or left out, one sentence each
};

/// Called with the stage's name and the proportion done, 0..1; returning false interrupts the bake.
using BakeProgress = std::function<bool(const std::string& stage, double done)>;

/// Builds the model of a scene. Throws Error naming the surface or volume, the place and the remedy.
Model bake(const Scene& scene, BakeReport* report = nullptr, const BakeProgress& progress = {});

}  // namespace frontalis
