#include "cli/stability_scenes.hpp"

#include "cli/model_source.hpp"

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

// The places where a folder of the package may be: installed (bin/ or lib/frontalis/ beside share/), in a bundle (bin/
// beside `bundled`), or in the sources.
std::vector<fs::path> folders(const std::string& shared, const std::string& bundled, const std::string& source)
{
  std::error_code none;
  const fs::path program = fs::read_symlink("/proc/self/exe", none).parent_path();
  return { program / "../share/frontalis" / shared, program / "../../share/frontalis" / shared,
           program / ".." / bundled, fs::path(FRONTALIS_SOURCE_DIRECTORY) / source };
}

}  // namespace

std::string stability_folder(const std::string& given)
{
  if (!given.empty())
    return given;
  for (const fs::path& folder : folders("stability", "stability", "test/stability"))
    if (fs::is_directory(folder))
      return folder.lexically_normal().string();
  throw Error(
      "the files of the hard cases (stability/*.yaml) are not beside the program; --cases must name their folder");
}

std::shared_ptr<const Model> stability_scene(const StabilityScenes& where, const std::string& name)
{
  const bool real = name == "real_head";
  if (real && where.mesh_directory.empty())
    throw Skipped{ "needs meshes (--mesh-dir)" };
  const std::vector<fs::path> given{ where.folder };
  for (const fs::path& folder : where.folder.empty() ? folders("config", "models/stability", "config") : given)
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
