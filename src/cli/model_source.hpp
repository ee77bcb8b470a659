#pragma once

#include "frontalis/model/model.hpp"

#include <string>
#include <vector>

namespace CLI
{
class App;
}

namespace frontalis
{

/// What the command line says about the scene or model to take.
struct ModelSource
{
  std::string path;
  std::string mesh_directory;
  std::string accuracy;
  std::string voxel;
  std::string cache;  ///< folder of models by content hash: taken from there, or left there; empty: none
};

/// What a bake told, ready to print.
struct BakeSummary
{
  bool whole = false;                ///< to be set before: measure the muscles too
  std::string cache;                 ///< what became of the cache, a sentence; empty: none was asked for
  std::vector<std::string> stages;   ///< seconds, peak memory and name
  std::vector<std::string> muscles;  ///< a table of their volumes, heading first; empty: none
  std::vector<std::string> findings;
};

/// Declares --mesh-dir, --accuracy and --voxel.
void add_scene_options(CLI::App& command, ModelSource& source);

/// By its extension (.vtkhdf, .h5, .hdf5) or by the signature of HDF5 at its beginning.
bool is_model_file(const std::string& path);

/// Reads a scene and bakes it, telling its progress. Throws Error, Interrupted.
Model bake_scene(const ModelSource& source, BakeSummary* summary = nullptr);

/// Reads a model file, or reads a scene and bakes it. Throws Error, WrongUsage, Interrupted.
Model obtain_model(const ModelSource& source);

}  // namespace frontalis
