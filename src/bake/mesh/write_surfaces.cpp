#include "frontalis/bake/write_surfaces.hpp"

#include "bake/mesh/surface.hpp"
#include "bake/messages.hpp"
#include "bake/shapes/head/follow_head.hpp"
#include "frontalis/scene/head_template.hpp"

#include <filesystem>
#include <fstream>

namespace frontalis
{

void write_surfaces(const Scene& scene, const std::string& folder)
{
  std::error_code ignored;
  std::filesystem::create_directories(folder, ignored);
  const auto path_of = [&folder](const Surface& surface)
  { return (std::filesystem::path(folder) / (surface.name + ".obj")).string(); };
  std::vector<std::string> inputs;
  for (const Surface& given : scene.surfaces)
    if (given.shape && given.shape->head)
      inputs.insert(inputs.end(), given.shape->head->files.begin(), given.shape->head->files.end());
    else if (!given.file.empty())
      inputs.push_back(given.file);
  for (const Surface& written : scene.surfaces)
    for (const std::string& input : inputs)
      if (std::filesystem::equivalent(path_of(written), input, ignored))
        throw Error(path_of(written) + ": is a file of the scene; surfaces must be written to another folder");
  const Scene moved = following_head(scene);
  for (const Surface& surface : moved.surfaces)
  {
    TriangleMesh mesh;
    try
    {
      mesh = load_surface(surface, scene.unit).mesh;
    }
    catch (const Error& error)
    {
      throw Error(place_in_scene(scene, "surface", surface) + ": " + error.what());
    }
    // The file appears when it is whole.
    const std::string path = path_of(surface), partial = path + ".partial";
    std::ofstream file(partial);
    for (const Vector3& p : mesh.vertices)
      file << fmt::format("v {:.9g} {:.9g} {:.9g}\n", p[0], p[1], p[2]);
    for (const Triangle& t : mesh.triangles)
      file << fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
    file.close();
    std::error_code failed;
    if (file)
      std::filesystem::rename(partial, path, failed);
    if (!file || failed)
    {
      std::filesystem::remove(partial, ignored);
      throw Error(path + ": cannot be written");
    }
  }
}

}  // namespace frontalis
