#include "frontalis/model/model_file.hpp"

#include "frontalis/error.hpp"
#include "model/model_layout.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>

namespace frontalis
{
namespace
{

const std::string root = "/frontalis";
const std::string package_version = "package_version";

void write_whole(const Model& model, const std::string& path)
{
  Hdf5File file = Hdf5File::create(path);
  write_vtk_arrays(file, model);
  file.make_group(root);
  file.write_attribute(root, "model_file_version", std::vector<std::int64_t>{ model_file_version });
  ModelWriter writer(file, root);
  exchange_model(writer, model);
  writer(package_version, std::string(FRONTALIS_VERSION));
  file.close();
}

/// Flushes a file, or the entries of a folder, to the disk.
void synchronise(const std::string& path)
{
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0)
    throw Error(std::string("cannot be opened again: ") + std::strerror(errno));
  const int result = ::fsync(descriptor);
  const int reason = errno;
  ::close(descriptor);
  // Some file systems cannot synchronise folders.
  if (result != 0 && reason != EINVAL)
    throw Error(std::string("cannot be written to the disk: ") + std::strerror(reason));
}

/// Reads a model. If `scene_hash` is not null, the model must have been baked from the scene with this hash.
Model read(const std::string& path, const std::string* scene_hash)
{
  try
  {
    const Hdf5File file = Hdf5File::open(path);
    const std::int64_t version = file.attribute(root, "model_file_version", -1);
    if (version < 0)
      throw Error("is an HDF5 file, but not a model; must be written by 'frontalis bake'");
    if (version != model_file_version)
      throw Error(fmt::format("has version {}; this program reads version {}: {}bake the scene again", version,
                              model_file_version, version > model_file_version ? "update the program, or " : ""));
    Model model;
    ModelReader reader(file, root);
    if (scene_hash != nullptr)
    {
      std::string baked_by;
      reader(package_version, baked_by);
      reader("scene_hash", model.scene_hash);
      if (model.scene_hash != *scene_hash)
        throw Error(fmt::format("is of another scene (content hash '{}', not '{}'); bake the scene again",
                                model.scene_hash, *scene_hash));
      if (baked_by != FRONTALIS_VERSION)
        throw Error(fmt::format("was baked by version {} of frontalis, and this is {}; bake the scene again", baked_by,
                                FRONTALIS_VERSION));
    }
    exchange_model(reader, model);
    build_nodes(model);
    check_model(model);
    return model;
  }
  catch (const Error& error)
  {
    throw Error("model file " + path + ": " + error.what());
  }
}

}  // namespace

void write_model(const Model& model, const std::string& name)
{
  // A link to a file stays, and the file is replaced.
  std::error_code missing;
  const std::filesystem::path target = std::filesystem::canonical(name, missing);
  const std::string path = missing ? name : target.string();
  if (!missing && !std::filesystem::is_regular_file(target))
    throw Error("model file " + name + ": is there already and is no regular file; give another name");
  const std::string partial = path + ".partial-" + std::to_string(::getpid());
  try
  {
    check_model(model);
    write_whole(model, partial);
    synchronise(partial);
    if (std::rename(partial.c_str(), path.c_str()) != 0)
      throw Error(std::string("cannot take its name: ") + std::strerror(errno));
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    synchronise(folder.empty() ? "." : folder.string());
  }
  catch (const Error& error)
  {
    std::remove(partial.c_str());
    throw Error("model file " + name + ": " + error.what());
  }
  catch (...)
  {
    std::remove(partial.c_str());
    throw;
  }
}

bool has_model(const std::string& path)
{
  try
  {
    return Hdf5File::open(path).attribute(root, "model_file_version", -1) >= 0;
  }
  catch (const Error&)
  {
    return false;
  }
}

Model read_model(const std::string& path) { return read(path, nullptr); }

Model read_model_of(const std::string& path, const std::string& scene_hash) { return read(path, &scene_hash); }

}  // namespace frontalis
