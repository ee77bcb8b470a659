#pragma once

#include "frontalis/scene/scene.hpp"

#include <string>

namespace frontalis
{

struct SceneOptions
{
  std::string mesh_directory;  ///< folder of the surface files; empty: `mesh_dir` of the scene, else its folder
  std::string accuracy;        ///< profile name, or a file with one profile (.yaml); empty: the scene's default
  double voxel = 0;            ///< [m] overrides the profile's voxel edge; 0: no override
  std::string voxel_quantity;  ///< overrides `voxel`; as text: "1.5" (in the scene's length unit) or "1.5 mm"
};

/// Reads and checks a scene file (doc/scene.md). Throws Error with every fault of the file, one per line:
/// FILE:LINE: KEY: what was found; what is allowed.
Scene read_scene(const std::string& path, const SceneOptions& options = {});

/// Scene::content of a scene whose settings were changed after reading. Throws Error if a mesh file cannot be read.
std::string content_of(const Scene& scene);

}  // namespace frontalis
