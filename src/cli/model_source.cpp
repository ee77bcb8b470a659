#include "cli/model_source.hpp"

#include "cli/command.hpp"
#include "cli/progress.hpp"

#include "frontalis/error.hpp"
#include "frontalis/model/model_file.hpp"
#ifdef FRONTALIS_WITH_BAKE
#include "frontalis/bake/bake.hpp"
#include "frontalis/bake/write_surfaces.hpp"
#include "frontalis/content_hash.hpp"
#endif

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <filesystem>
#include <fstream>
#include <optional>

namespace frontalis
{

void add_scene_options(CLI::App& command, ModelSource& source)
{
  command.add_option("--mesh-dir", source.scene.mesh_directory, "folder of the scene's mesh files");
  command.add_option("--accuracy", source.scene.accuracy,
                     "name of one of the scene's accuracy profiles, or a file with one (.yaml)");
  command.add_option("--voxel", source.scene.voxel_quantity,
                     "voxel edge, in the scene's length unit (1.5) or with one (\"1.5 mm\")");
}

bool is_model_file(const std::string& path)
{
  const std::string extension = std::filesystem::path(path).extension().string();
  if (extension == ".vtkhdf" || extension == ".h5" || extension == ".hdf5")
    return true;
  // The first eight bytes of every HDF5 file.
  const std::string signature = "\x89HDF\r\n\x1a\n";
  std::string begin(signature.size(), '\0');
  std::ifstream file(path, std::ios::binary);
  return file.read(begin.data(), static_cast<std::streamsize>(begin.size())) && begin == signature;
}

void check_output(const std::string& path, const std::string& what)
{
  if (path.empty())
    return;
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored))
    throw Error(path + ": no folder '" + folder.string() + "' to write it in; must exist");
  if (std::filesystem::is_directory(path, ignored))
    throw Error(path + ": is a folder; must be " + what);
}

void check_model_output(const std::string& path)
{
  const std::string what = "the path of a model file (.vtkhdf)";
  if (path.empty())
    throw WrongUsage("--output: must be " + what);
  check_output(path, what);
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored))
    return;
  if (!std::filesystem::is_regular_file(path, ignored))
    throw Error(path + ": is no regular file; must be " + what);
  if (std::filesystem::file_size(path, ignored) > 0 && !has_model(path))
    throw Error(path + ": exists and is no model; must be a new file or a model to replace");
}

#ifdef FRONTALIS_WITH_BAKE

namespace
{

// The file beside a cached model with the warnings of its bake, one per line; empty without warnings.
std::string warnings_beside(const std::string& path) { return path + ".warnings"; }

// The cached model with the given hash of its scene, if it is usable, and the warnings of its bake. `told` receives a
// sentence about the result.
std::optional<Model> cached_model(const std::string& path, const std::string& hash, std::string& told,
                                  std::vector<std::string>& warnings)
{
  if (path.empty() || !std::filesystem::exists(path))
    return std::nullopt;
  try
  {
    Model model = read_model_of(path, hash);
    std::ifstream file(warnings_beside(path));
    if (!file)
      throw Error(warnings_beside(path) + " is missing");
    for (std::string line; std::getline(file, line);)
      warnings.push_back(line);
    told = "taken from " + path;
    return model;
  }
  catch (const Error& error)
  {
    told = std::string("not usable: ") + error.what() + "; ";
    return std::nullopt;
  }
}

// Stores the model. A failure is not an error, because the bake has succeeded.
void keep_in_cache(const Model& model, const std::vector<std::string>& warnings, const std::string& path,
                   std::string& told)
{
  if (path.empty())
    return;
  try
  {
    std::filesystem::create_directories(std::filesystem::path(path).parent_path());
    std::ofstream file(warnings_beside(path));
    for (const std::string& warning : warnings)
      file << warning << '\n';
    if (!file.flush())
      throw Error(warnings_beside(path) + " cannot be written");
    write_model(model, path);
    told += "kept as " + path;
  }
  catch (const std::exception& error)
  {
    told += std::string("not kept: ") + error.what();
  }
}

std::string table_of(const std::vector<BakeReport::SurfaceExtent>& surfaces)
{
  if (surfaces.empty())
    return {};
  std::string table = fmt::format("surface  {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>9} {:>8}\n", "x from", "to mm",
                                  "y from", "to mm", "z from", "to mm", "triangles", "cm3");
  for (const BakeReport::SurfaceExtent& surface : surfaces)
  {
    table += "surface ";
    for (std::size_t axis = 0; axis < 3; ++axis)
      table += fmt::format(" {:8.1f} {:8.1f}", 1e3 * surface.lower[axis], 1e3 * surface.upper[axis]);
    table += fmt::format(" {:9} {:>8}  {}\n", surface.triangles,
                         surface.volume > 0 ? fmt::format("{:.4g}", 1e6 * surface.volume) : "open", surface.name);
  }
  return table;
}

BakeSummary summary_of(const BakeReport& report)
{
  BakeSummary summary{ report.measure_muscles, {}, table_of(report.surfaces), report.findings, report.warnings };
  for (const BakeReport::Stage& stage : report.stages)
    summary.stages +=
        fmt::format("stage    {:8.3f} s  {:6.0f} MB  {}\n", stage.seconds, stage.peak_memory / 1e6, stage.name);
  if (!report.muscles.empty())
    summary.tables += fmt::format("muscle   {:>8} {:>9} {:>7} {:>8} {:>8} {:>8} {:>8} {:>8}  cm3\n", "voxels",
                                  "in tissue", "differ", "mesh", "in bone", "off skin", "limits", "nurbs");
  for (const BakeReport::MuscleVolume& muscle : report.muscles)
    summary.tables +=
        fmt::format("muscle   {:8.3f} {:9.3f} {:6.1f}% {:8.3f} {:8.3f} {:8.3f} {:8.3f} {:>8}  {}\n",
                    1e6 * muscle.voxels, 1e6 * muscle.in_tissue, 100 * (muscle.voxels / muscle.in_tissue - 1),
                    1e6 * muscle.mesh, 1e6 * muscle.in_bone, 1e6 * muscle.beyond_skin, 1e6 * muscle.elsewhere,
                    muscle.nurbs > 0 ? fmt::format("{:.3f}", 1e6 * muscle.nurbs) : "-", muscle.name);
  if (!report.forces.empty())
    summary.tables += fmt::format("strength {:>8} {:>9} {:>9} {:>7} {:>8} {:>7}\n", "fibre mm", "model mm2", "people",
                                  "factor", "force N", "left %");
  for (const BakeReport::MuscleForce& force : report.forces)
    summary.tables += fmt::format(
        "strength {:8.1f} {:9.1f} {:>9} {:7.2f} {:8.2f} {:7.0f}  {}\n", 1e3 * force.length, 1e6 * force.cross_section,
        force.given > 0 ? fmt::format("{:.1f}", 1e6 * force.given) : "-",
        force.given > 0 ? force.given / force.cross_section : 1.0, force.force, 100 * force.left, force.name);
  return summary;
}

}  // namespace

Model bake_interruptibly(const Scene& scene, BakeReport* report,
                         const std::function<void(const std::string&, double)>& progress)
{
  Model model;
  try
  {
    model = bake(scene, report,
                 [&progress](const std::string& stage, double done)
                 {
                   progress(stage, done);
                   return !interrupt_requested();
                 });
  }
  catch (const Error&)
  {
    // bake() also throws Error when it is interrupted.
    if (!interrupt_requested())
      throw;
  }
  if (interrupt_requested())
    throw Interrupted();
  return model;
}

Model bake_scene(const ModelSource& source, BakeSummary* summary)
{
  const Scene scene = read_scene(source.path, source.scene);
  if (!source.surfaces.empty())
    write_surfaces(scene, source.surfaces);
  const std::string hash = content_hash(scene.content);
  const std::string cached =
      source.cache.empty() ? "" : (std::filesystem::path(source.cache) / (hash + ".vtkhdf")).string();
  std::string of_cache;
  BakeReport report;
  report.measure_muscles = summary != nullptr && summary->whole;
  const auto print_warnings = [&]
  {
    for (const std::string& warning : report.warnings)
      fmt::print(source.progress, "warning  {}\n", warning);
  };
  std::optional<Model> model = cached_model(cached, hash, of_cache, report.warnings);
  if (!model)
  {
    Progress progress(source.progress);
    try
    {
      model = bake_interruptibly(scene, &report,
                                 [&](const std::string& stage, double done) { progress.update(stage, done); });
    }
    catch (const std::exception&)
    {
      // What is probably a mistake may be the cause, of lack of memory too.
      progress.clear();
      print_warnings();
      if (report.measure_muscles)
        fmt::print(source.progress, "{}", table_of(report.surfaces));
      throw;
    }
    keep_in_cache(*model, report.warnings, cached, of_cache);
  }
  if (summary == nullptr)
    print_warnings();
  else
  {
    *summary = summary_of(report);
    if (!of_cache.empty())
      summary->stages.insert(0, "cache    " + of_cache + "\n");
  }
  return *std::move(model);
}

#else

Model bake_scene(const ModelSource& source, BakeSummary* /*summary*/)
{
  throw Error(source.path + ": is a scene, and this program was built without baking; give a baked model (.vtkhdf)");
}

#endif

Model obtain_model(const ModelSource& source)
{
  if (!std::filesystem::exists(source.path))
    throw Error(source.path + ": no such file; must be a scene (YAML) or a baked model (.vtkhdf)");
  if (!is_model_file(source.path))
    return bake_scene(source);
  for (const auto& [option, text] : { std::pair{ "--mesh-dir", source.scene.mesh_directory },
                                      { "--accuracy", source.scene.accuracy },
                                      { "--voxel", source.scene.voxel_quantity } })
    if (!text.empty())
      throw WrongUsage(fmt::format("{} goes with a scene; '{}' is already a baked model", option, source.path));
  return read_model(source.path);
}

}  // namespace frontalis
