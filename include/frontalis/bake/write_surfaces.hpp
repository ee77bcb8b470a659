#pragma once

#include "frontalis/scene/scene.hpp"

namespace frontalis
{

/// Writes each surface of a scene, as the bake makes or repairs it, to FOLDER/NAME.obj in metres. Creates the folder if
/// it is missing. Throws Error naming the surface, or the file that cannot be written.
void write_surfaces(const Scene& scene, const std::string& folder);

}  // namespace frontalis
