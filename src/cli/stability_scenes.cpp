#include "stability_scenes.hpp"

#include "model_source.hpp"

#include "frontalis/error.hpp"
#include "frontalis/model/model_file.hpp"
#include "frontalis/study/stability.hpp"

#include <filesystem>
#include <vector>

namespace frontalis
{
namespace
{

namespace fs = std::filesystem;

// folders that may hold scenes or models: given, installed (bin/ or lib/frontalis/ beside share/), of a bundle (bin/
// beside models/), the sources'
std::vector<fs::path> folders(const StabilityScenes& where)
{
  if (!where.folder.empty())
    return { where.folder };
  std::error_code none;
  const fs::path program = fs::read_symlink("/proc/self/exe", none).parent_path();
  const fs::path sources(FRONTALIS_SOURCE_DIRECTORY);
  return { program / "../share/frontalis/config", program / "../../share/frontalis/config",
           program / "../models/stability", sources / "config" };
}

}  // namespace

std::shared_ptr<const Model> stability_scene(const StabilityScenes& where, const std::string& name)
{
  const bool real = name == "real_head";
  if (real && where.mesh_directory.empty())
    throw Skipped{ "needs meshes (--mesh-dir)" };
  for (const fs::path& folder : folders(where))
  {
    const fs::path model = folder / (name + ".vtkhdf");
    if (fs::exists(model))
      return std::make_shared<const Model>(read_model(model.string()));
    const fs::path scene = folder / (name + ".yaml");
    if (!fs::exists(scene))
      continue;
#ifdef FRONTALIS_WITH_BAKE
    ModelSource source;
    source.path = scene.string();
    if (real)
      source.mesh_directory = where.mesh_directory;
    return std::make_shared<const Model>(bake_scene(source));
#else
    throw Skipped{ "this build bakes no scenes, and there is no " + name + ".vtkhdf" };
#endif
  }
  if (!where.folder.empty())
    throw Error(where.folder + ": has neither " + name + ".yaml nor " + name + ".vtkhdf");
  throw Skipped{ "no " + name + ".yaml or .vtkhdf here (--scenes)" };
}

}  // namespace frontalis
