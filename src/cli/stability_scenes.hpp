#pragma once

#include "frontalis/model/model.hpp"

#include <memory>
#include <string>

namespace frontalis
{

/// Where the scenes of hard cases are.
struct StabilityScenes
{
  std::string folder;  ///< empty: beside the program, as installed or bundled, else the sources'
  std::string mesh_directory;
};

/// Folder of the cases' files: that given, or where it is empty beside the program, as installed or bundled, else the
/// sources'. Throws Error where there is none.
std::string stability_folder(const std::string& given);

/// A scene of that name, baked, or the model that was baked from it. Throws Skipped where this build cannot bake or
/// the scene needs meshes that were not given, Error where the scene is wrong, Interrupted.
std::shared_ptr<const Model> stability_scene(const StabilityScenes& where, const std::string& name);

}  // namespace frontalis
