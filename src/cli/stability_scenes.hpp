#pragma once

#include "frontalis/model/model.hpp"

#include <memory>
#include <string>

namespace frontalis
{

/// Where the scenes of hard cases are found.
struct StabilityScenes
{
  std::string folder;  ///< empty: beside the program, or in the sources
  std::string mesh_directory;
};

/// Folder of the cases' files: `given`, or, if that is empty, the one beside the program or in the sources. Throws
/// Error if there is none.
std::string stability_folder(const std::string& given);

/// Reads or bakes the model of the scene called `name`. Throws Skipped if this build cannot bake or the scene needs
/// meshes that were not given, Error if the scene is wrong, Interrupted on Ctrl-C.
std::shared_ptr<const Model> stability_scene(const StabilityScenes& where, const std::string& name);

}  // namespace frontalis
