#include "frontalis/scene/read_scene.hpp"

#include "scene/content.hpp"
#include "scene/sections.hpp"

#include "frontalis/error.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>

namespace frontalis
{
namespace
{

std::string read_text(const std::string& path, const std::string& what)
{
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored))
    throw Error(path + ": no such file; must be a " + what + " in YAML");
  std::ifstream file(path, std::ios::binary);
  if (std::filesystem::is_directory(path, ignored) || !file)
    throw Error(path + ": cannot be read; must be a " + what + " in YAML");
  return { std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>() };
}

void read_unit(const Node& node)
{
  try
  {
    if (const std::string text = node.text(); !text.empty())
      node.context().length_unit = parse_length_unit(text);
  }
  catch (const Error& error)
  {
    node.fault(error.what());
  }
}

void read_root(const Node& root, const SceneOptions& options, Scene& scene)
{
  Mapping mapping(root);
  SceneNames names;
  // the unit comes first: every length needs it
  read_unit(mapping.required("unit", "the length unit of plain numbers: m, cm, mm, um or in"));
  scene.unit = root.context().length_unit;
  const Node mesh_directory = mapping.optional("mesh_dir");
  read_frame(mapping.optional("frame"), scene.frame);
  read_surfaces(mapping.required("surfaces", "a mapping of surfaces"), mesh_directory, options, scene, names);
  read_materials(mapping.required("materials", "a mapping of materials"), scene, names);
  read_volumes(mapping.required("volumes", "a mapping of volumes"), scene, names);
  read_layers(mapping.optional("layers"), scene, names);
  read_muscles(mapping.optional("muscles"), scene, names);
  read_constraints(mapping.optional("constraints"), scene, names);
  read_loads(mapping.optional("loads"), scene, names);
  read_skin(mapping.required("skin", "the surface to publish: {surface: NAME}"), scene.skin, names);
  read_landmarks(mapping.optional("landmarks"), scene);
  scene.gravity = mapping.optional("gravity").vector(Dimension::acceleration, any_number, scene.gravity);
  read_effects(mapping.optional("effects"), scene);
  read_time(mapping.optional("time"), scene.time);
  read_accuracy(mapping.optional("accuracy"), options, scene, names);
  read_expressions(mapping.optional("expressions"), scene, names);
  read_demo(mapping.optional("demo"), scene, names);
}

}  // namespace

YAML::Node load_yaml(const std::string& path, const std::string& what, const std::string& expected)
{
  const auto place = [&](int line) { return fmt::format("{}:{}: {}: ", path, line, what); };
  YAML::Node root;
  try
  {
    root = YAML::Load(read_text(path, what));
  }
  catch (const YAML::Exception& error)
  {
    throw Error(place(error.mark.is_null() ? 1 : error.mark.line + 1) + "not YAML: " + error.msg + "; must be " +
                expected);
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
  scene.content = canonical_content(scene);
  return scene;
}

std::string content_of(const Scene& scene) { return canonical_content(scene); }

}  // namespace frontalis
