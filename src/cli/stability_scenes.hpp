#pragma once

#include "frontalis/model/model.hpp"

#include <memory>
#include <string>

namespace frontalis
{

/// The places of the scenes of hard cases.
struct StabilityScenes
{
  std::string folder;  ///< empty: beside the program, or in the sources
  std::string mesh_directory;
};

/// Folder of the cases' files: `given`, or, where that is empty, the one beside the program or in the sources. Throws
/// Error where there is none.
std::string stability_folder(const std::string& given);

/// The model of the scene of that name, read or baked. Throws Skipped where this build cannot bake or the scene needs
/// meshes that were not given, Error where the scene is wrong, Interrupted.
std::shared_ptr<const Model> stability_scene(const StabilityScenes& where, const std::string& name);

}  // namespace frontalis
