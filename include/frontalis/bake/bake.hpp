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
    double peak_memory = 0;  ///< peak memory of the process since its start, at the end of the stage [bytes]
  };
  /// Volumes of a muscle [m3]. `voxels` is its volume in the model. All others are integrated, without voxels, over
  /// points on parallel lines through the muscle's surfaces.
  struct MuscleVolume
  {
    std::string name;
    double voxels = 0;
    double mesh = 0;         ///< inside the muscle's surfaces
    double in_tissue = 0;    ///< the part of `mesh` in the tissue and within the muscle's own limits
    double in_bone = 0;      ///< clipped part inside a surface that bounds the tissue or the muscle from within
    double beyond_skin = 0;  ///< clipped part outside the surfaces that enclose the tissue
    double elsewhere = 0;    ///< part clipped by a range of depth or a crop
    double nurbs = 0;        ///< inside the NURBS volume fitted to its fibres; 0 if there is none
  };
  /// Strength of a muscle. The model's cross-section is the muscle's volume in voxels divided by the mean length of its
  /// fibres. If the scene gives a cross-section, the bake multiplies the reference stress by given / cross_section.
  struct MuscleForce
  {
    std::string name;
    double length = 0;         ///< mean length of the fibres [m]
    double cross_section = 0;  ///< cross-section in the model [m2]
    double given = 0;          ///< cross-section in people, from the scene [m2]; 0: not given
    double force = 0;          ///< force at full activation and optimal length, without weaknesses of the scene [N]
    double left = 1;           ///< fraction of it that these leave, 0..1
  };
  /// A surface of the scene, after repairs, in scene coordinates.
  struct SurfaceExtent
  {
    std::string name;
    Vector3 lower{}, upper{};  ///< corners of the box around it [m]
    std::size_t triangles = 0;
    double volume = 0;  ///< that it encloses [m3]; 0: it is open
  };
  std::vector<SurfaceExtent> surfaces;  ///< in the scene's order; empty if one is refused
  std::vector<Stage> stages;
  std::vector<MuscleForce> forces;
  std::vector<MuscleVolume> muscles;  ///< muscles bounded by surfaces; filled if `measure_muscles` is set
  bool measure_muscles = false;       ///< the caller may set it before the bake; costs some seconds
  std::vector<std::string> findings;  ///< repairs, clippings and omissions, one sentence each
  std::vector<std::string> warnings;  ///< what is probably a mistake, one sentence each
};

/// Called with the name of the stage and the proportion of it that is done, 0..1. To interrupt the bake, return false.
using BakeProgress = std::function<bool(const std::string& stage, double done)>;

/// Builds the model of a scene. Throws Error naming the surface or volume, the position and the remedy.
Model bake(const Scene& scene, BakeReport* report = nullptr, const BakeProgress& progress = {});

}  // namespace frontalis
