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
    double peak_memory = 0;  ///< largest memory of the process until the stage's end [bytes]
  };
  /// Volumes of a muscle [m3]. `voxels` is what the model carries. The others are measured on the surfaces, without
  /// voxels: from the lengths of parallel lines inside the muscle, and from points on them that are tested for bone,
  /// skin and depth.
  struct MuscleVolume
  {
    std::string name;
    double voxels = 0;
    double mesh = 0;         ///< inside the muscle's surfaces
    double in_tissue = 0;    ///< of it: in the tissue and within the muscle's own limits
    double in_bone = 0;      ///< clipped: inside surfaces that the tissue lies outside of
    double beyond_skin = 0;  ///< clipped: outside the surfaces that the tissue lies inside of
    double elsewhere = 0;    ///< clipped: by a depth or a crop
    double nurbs = 0;        ///< inside the NURBS volume of its fibres; 0 if it has none
  };
  std::vector<Stage> stages;
  std::vector<MuscleVolume> muscles;  ///< of muscles made of surfaces, if `measure_muscles` is set
  bool measure_muscles = false;       ///< set by the caller before the bake; takes seconds
  std::vector<std::string> findings;  ///< what was repaired, clipped, removed or left out, one sentence each
};

/// Called with the stage's name and the proportion done, 0..1; returning false interrupts the bake.
using BakeProgress = std::function<bool(const std::string& stage, double done)>;

/// Builds the model of a scene. Throws Error naming the surface or volume, the place and the remedy.
Model bake(const Scene& scene, BakeReport* report = nullptr, const BakeProgress& progress = {});

}  // namespace frontalis
