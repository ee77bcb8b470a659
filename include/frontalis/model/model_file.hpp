#pragma once

#include "frontalis/model/model.hpp"

#include <string>

namespace frontalis
{

/// Version of the file layout; files of another version are refused.
constexpr int model_file_version = 12;

/// Writes the model to a temporary file beside `path`, which is then renamed, so that no partial file remains at
/// `path`. Equal models give equal bytes. Throws Error.
void write_model(const Model& model, const std::string& path);

/// Whether the file is a model, of any version.
bool has_model(const std::string& path);

/// Reads and checks a model. Throws Error with the path and the fault: a missing or truncated file, another version.
Model read_model(const std::string& path);

/// Like read_model(), but also throws Error unless this version of the package baked the model from the scene with that
/// hash.
Model read_model_of(const std::string& path, const std::string& scene_hash);

}  // namespace frontalis
