#pragma once

#include "frontalis/scene/scene.hpp"

#include <string>

namespace frontalis
{

struct SceneOptions
{
  std::string mesh_directory;  ///< folder of the surface files; empty: `mesh_dir` of the scene, else the scene's folder
  std::string accuracy;        ///< profile name, or a file with one profile (.yaml); empty: the scene's default
  double voxel = 0;            ///< voxel edge [m] in place of the profile's; 0: no override
  std::string voxel_quantity;  ///< replaces `voxel` by a text: "1.5" (in the scene's length unit) or "1.5 mm"
};

/// Reads and checks a scene file (doc/scene.md). Throws Error with every fault of the file, one per line:
/// FILE:LINE: KEY: what was found; what is allowed.
Scene read_scene(const std::string& path, const SceneOptions& options = {});

/// Computes Scene::content anew, for a scene that was changed. Throws Error if a mesh file cannot be read.
std::string content_of(const Scene& scene);

}  // namespace frontalis
