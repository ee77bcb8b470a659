#pragma once

#include "frontalis/model/model.hpp"
#include "frontalis/scene/read_scene.hpp"

#include <cstdio>
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

/// The scene or model that the command line names.
struct ModelSource
{
  std::string path;
  SceneOptions scene;
  std::string cache;             ///< folder that keeps models by the hash of their scene; empty: none
  std::string surfaces;          ///< folder to write the scene's surfaces to; empty: none
  std::FILE* progress = stdout;  ///< receives the names of a bake's stages if stderr is not a terminal
};

/// The report of a bake, ready to print.
struct BakeSummary
{
  bool whole = false;  ///< set before the bake in order to measure the muscles too
  std::string stages;  ///< use of the cache, if there is one; seconds, peak memory and name of each stage
  std::string tables;  ///< of the surfaces' extents, and of the muscles' volumes and strengths
  std::vector<std::string> findings;
  std::vector<std::string> warnings;  ///< bake_scene() prints them if there is no summary
};

/// Declares --mesh-dir, --accuracy and --voxel.
void add_scene_options(CLI::App& command, ModelSource& source);

/// Whether a file is a baked model: by its extension (.vtkhdf, .h5, .hdf5) or the signature of HDF5 at its beginning.
bool is_model_file(const std::string& path);
/// Throws Error, before long work, if a file could not be written to this path; an empty path stands for none. `what`:
/// what the path must be.
void check_output(const std::string& path, const std::string& what = "the path of a file");
/// The same for a model, which must not replace something else than a model or an empty file.
void check_model_output(const std::string& path);

/// Reads a scene and bakes it, and shows the progress. Throws Error, Interrupted.
Model bake_scene(const ModelSource& source, BakeSummary* summary = nullptr);

/// Like bake(), but throws Interrupted after Ctrl-C. Exists only in builds that can bake.
Model bake_interruptibly(const Scene& scene, BakeReport* report,
                         const std::function<void(const std::string& stage, double done)>& progress);

/// Reads a model file, or reads a scene and bakes it. Throws Error, WrongUsage, Interrupted.
Model obtain_model(const ModelSource& source);

}  // namespace frontalis
