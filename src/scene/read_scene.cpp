#include "frontalis/scene/read_scene.hpp"

#include "scene/sections.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <utility>

namespace frontalis
{
namespace
{

std::string read_text(const std::string& path, const std::string& what)
{
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored))
    throw Error(path + ": no such file; give a YAML file (" + what + ")");
  std::ifstream file(path, std::ios::binary);
  if (std::filesystem::is_directory(path, ignored) || !file)
    throw Error(path + ": cannot be read; give a YAML file (" + what + ")");
  return { std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>() };
}

// Leaves out the tissues of the library that nothing uses.
void leave_out_unused(Scene& scene)
{
  const auto unused = [&](const SceneMaterial& material)
  {
    const auto has = [&](const auto& item) { return item.material == material.name; };
    const auto in_film = [&](const SceneFilm& film)
    { return film.material == material.name || film.base == material.name; };
    const std::vector<std::string>& scaled = scene.accuracy.mass_scaling.materials;
    return material.of_library && std::none_of(scene.volumes.begin(), scene.volumes.end(), has) &&
           std::none_of(scene.layers.begin(), scene.layers.end(), has) &&
           std::none_of(scene.films.begin(), scene.films.end(), in_film) &&
           std::find(scaled.begin(), scaled.end(), material.name) == scaled.end();
  };
  auto& all = scene.materials;
  all.erase(std::remove_if(all.begin(), all.end(), unused), all.end());
}

// A generated forehead has triangles as small as voxels, or as small as they need to be: with edges of 0.25 mm its
// surfaces are off by 0.1 um. A study of accuracy changes the voxels afterwards, and all its models have the same
// triangles.
void divide_forehead(Surface& surface, double voxel)
{
  constexpr double finest_edge = 0.25e-3;  // [m]
  if (!surface.shape)
    return;
  Shape& shape = *surface.shape;
  if (shape.kind == Shape::Kind::forehead && shape.edge <= 0)
    shape.edge = std::min(shape.edge_or_default(), std::max(voxel, finest_edge));
  if (shape.below)
  {
    auto below = std::make_shared<Surface>(*shape.below);
    divide_forehead(*below, voxel);
    shape.below = std::move(below);
  }
}

// Checks the muscles that materials name. Materials are read before muscles, because muscles name materials too.
void check_tissues(const Scene& scene, const Node& tissues, const SceneNames& names)
{
  for (const SceneMaterial& material : scene.materials)
    if (material.of_library && !material.along.empty())
      Node("materials." + material.name + ".along", tissues.line(), tissues.context())
          .check_known(material.along, names.surfaces);
  for (const SceneMaterial& material : scene.materials)
    if (!material.about.empty())
      Node("materials." + material.name + ".families.about", material.of_library ? tissues.line() : material.line,
           tissues.context())
          .check_known(material.about, names.muscles);
}

void read_root(const Node& root, const SceneOptions& options, Scene& scene)
{
  Mapping mapping(root);
  SceneNames names;
  // The unit is read first, because all lengths depend on it.
  scene.unit = read_length_unit(mapping.required("unit", "the length unit of plain numbers: m, cm, mm, um or in"), 1);
  root.context().length_unit = scene.unit;
  const Node mesh_directory = mapping.optional("mesh_dir");
  read_frame(mapping.optional("frame"), scene.frame);
  read_surfaces(mapping.required("surfaces", "a mapping of surfaces"), mesh_directory, options, scene, names);
  const Node tissues = mapping.optional("tissues");
  read_materials(
      tissues,
      tissues.given() ? mapping.optional("materials") : mapping.required("materials", "a mapping of materials"), scene,
      names);
  read_volumes(mapping.required("volumes", "a mapping of volumes"), scene, names);
  read_layers(mapping.optional("layers"), scene, names);
  read_muscles(mapping.optional("muscles"), scene, names);
  read_weakness(mapping.optional("weakness"), scene, names);
  read_constraints(mapping.optional("constraints"), scene, names);
  read_loads(mapping.optional("loads"), scene, names);
  read_skin(mapping.required("skin", "the surface to publish: {surface: NAME}"), scene, names);
  read_landmarks(mapping.optional("landmarks"), scene, names);
  read_joints(mapping.optional("joints"), scene, names);
  scene.gravity = mapping.optional("gravity").vector(Dimension::acceleration, any_number, scene.gravity);
  read_effects(mapping.optional("effects"), scene);
  read_time(mapping.optional("time"), scene.time);
  read_accuracy(mapping.optional("accuracy"), options, scene, names);
  read_bone_centres(mapping.optional("bones"), scene, names);
  const Node action_units = mapping.optional("action_units");
  read_expressions(action_units, mapping.optional("expressions"), scene, names);
  read_demo(mapping.optional("demo"), scene, names);
  leave_out_unused(scene);
  for (Surface& surface : scene.surfaces)
    divide_forehead(surface, *std::min_element(scene.accuracy.voxel.begin(), scene.accuracy.voxel.end()));
  check_tissues(scene, tissues, names);
}

}  // namespace

double read_length(const Node& node, const Bound& bound) { return node.number(Dimension::length, bound, 0); }

double read_length_unit(const Node& node, double fallback)
{
  try
  {
    const std::string text = node.text();
    return text.empty() ? fallback : parse_length_unit(text);
  }
  catch (const Error& error)
  {
    node.fault(error.what());
  }
  return fallback;
}

std::string read_unique_name(Mapping& mapping, std::vector<std::string>& earlier)
{
  const Node node = mapping.required("name", "a name");
  std::string name = node.name();
  if (!name.empty() && std::find(earlier.begin(), earlier.end(), name) != earlier.end())
    node.fault("'" + name + "' is there already; names must differ");
  earlier.push_back(name);
  return name;
}

std::string one_of(const Node& entry, Mapping& mapping, const std::vector<std::string>& keys)
{
  std::vector<std::string> there;
  std::copy_if(keys.begin(), keys.end(), std::back_inserter(there), [&](const auto& key) { return mapping.has(key); });
  if (there.size() == 1)
    return there[0];
  if (entry.is_mapping())
    entry.fault("found {} of {}; must have exactly one", there.empty() ? "none" : fmt::format("{}", there.size()),
                fmt::join(keys, ", "));
  mapping.ignore_rest();
  return {};
}

YAML::Node load_yaml(const std::string& path, const std::string& what, const std::string& expected)
{
  const auto place = [&](int line) { return fmt::format("{}:{}: {}: ", path, line, what); };
  YAML::Node root;
  const std::string text = read_text(path, what);
  try
  {
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    if (documents.size() > 1)
      throw Error(place(documents[1].Mark().line + 1) +
                  "a second document begins here, after '---'; a file must be one");
    root = documents.empty() ? YAML::Node() : documents[0];
  }
  catch (const YAML::Exception& error)
  {
    const int line = error.mark.is_null() ? 0 : error.mark.line;
    std::istringstream lines(text);
    std::string at;
    for (int l = 0; l <= line; ++l)
      std::getline(lines, at);
    throw Error(place(line + 1) + "not YAML: " + error.msg +
                (at.find('\t') == std::string::npos
                     ? "; check the brackets, colons and indents of this line and of those above it"
                     : "; this line has a tab: indent with spaces"));
  }
  if (root.IsNull())
    throw Error(place(1) + "the file is empty; must be " + expected);
  if (!root.IsMap())
    throw Error(place(root.Mark().line + 1) + "found " + (root.IsSequence() ? "a list" : "plain text") + "; must be " +
                expected);
  return root;
}

Scene read_scene(const std::string& path, const SceneOptions& options)
{
  Scene scene;
  scene.file = path;
  const YAML::Node yaml = load_yaml(path, "scene", "a mapping with at least unit, surfaces, volumes, materials, skin");
  ReadingContext context{ Faults(path), 1 };
  read_root(Node(yaml, "", 1, context), options, scene);
  if (!context.faults.empty())
    throw Error(context.faults.text());
  scene.content = content_of(scene);
  return scene;
}

}  // namespace frontalis
