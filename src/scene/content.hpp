#pragma once

#include "frontalis/scene/scene.hpp"

#include <string>

namespace frontalis
{

/// Canonical text of everything in a scene that decides its model: numbers in SI units, and in place of each mesh
/// file's path the hash of its bytes. Names of files and folders, line numbers and profiles not chosen are left out.
/// Throws Error if a file cannot be read.
std::string canonical_content(const Scene& scene);

}  // namespace frontalis
