#pragma once

#include "frontalis/model/model.hpp"

#include <functional>
#include <string>
#include <vector>

namespace CLI
{
class App;
}

namespace frontalis
{

struct BakeReport;
struct Scene;

/// The scene or model that the command line names.
struct ModelSource
{
  std::string path;
  std::string mesh_directory;
  std::string accuracy;
  std::string voxel;
  std::string cache;  ///< folder that keeps models by the hash of their scene; empty: none
};

/// The report of a bake, ready to print.
struct BakeSummary
{
  bool whole = false;                ///< set before the bake: measure the muscles too
  std::string cache;                 ///< a sentence on how the cache was used; empty: there is no cache
  std::vector<std::string> stages;   ///< seconds, peak memory and name
  std::vector<std::string> muscles;  ///< a table of their volumes, heading first; empty: none
  std::vector<std::string> findings;
};

/// Declares --mesh-dir, --accuracy and --voxel.
void add_scene_options(CLI::App& command, ModelSource& source);

/// Judges by the extension (.vtkhdf, .h5, .hdf5) or by the signature of HDF5 at the file's beginning.
bool is_model_file(const std::string& path);

/// Reads a scene and bakes it, and shows the progress. Throws Error, Interrupted.
Model bake_scene(const ModelSource& source, BakeSummary* summary = nullptr);

/// Like bake(), but Ctrl-C makes it throw Interrupted. Only in builds that bake.
Model bake_interruptibly(const Scene& scene, BakeReport* report,
                         const std::function<void(const std::string& stage, double done)>& progress);

/// Reads a model file, or reads a scene and bakes it. Throws Error, WrongUsage, Interrupted.
Model obtain_model(const ModelSource& source);

}  // namespace frontalis
