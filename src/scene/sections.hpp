#pragma once

#include "scene/yaml_reader.hpp"

#include "frontalis/scene/read_scene.hpp"
#include "frontalis/scene/scene.hpp"

#include <map>
#include <string>
#include <vector>

namespace frontalis
{

/// Names defined by the sections read so far.
struct SceneNames
{
  Names surfaces{ "surface", {}, true };
  Names materials{ "material", {}, true };
  Names volumes{ "volume", {}, true };
  Names tissue_volumes{ "tissue volume", {}, true };
  Names muscles{ "muscle", {}, true };
  Names activations{ "muscle", {}, true };  ///< muscles, and loads with an activation of their own
  Names expressions{ "expression", { "relax" }, true };
  Names bones{ "bone", {}, true };
  std::map<std::string, std::vector<std::string>> muscle_sets;  ///< by set of surfaces the muscles among its parts
  std::map<std::string, Shape> heads;                           ///< sets of surfaces that are parts of a head
};

// One function per section, in the order in which the file is read. The section may be absent.
void read_frame(const Node& node, FaceFrame& frame);
void read_surfaces(const Node& node, const Node& mesh_directory, const SceneOptions& options, Scene& scene,
                   SceneNames& names);
/// Reads the file that `tissues` names, then the section, whose entries replace the file's materials of the same name.
void read_materials(const Node& tissues, const Node& node, Scene& scene, SceneNames& names);
void read_volumes(const Node& node, Scene& scene, SceneNames& names);
void read_layers(const Node& node, Scene& scene, const SceneNames& names);
void read_muscles(const Node& node, Scene& scene, SceneNames& names);
void read_weakness(const Node& node, Scene& scene, const SceneNames& names);
void read_constraints(const Node& node, Scene& scene, SceneNames& names);
void read_loads(const Node& node, Scene& scene, SceneNames& names);
/// Must be called after read_constraints(), because the constraints decide whether the scene has friction.
void read_effects(const Node& node, Scene& scene);
void read_skin(const Node& node, Scene& scene, const SceneNames& names);
void read_landmarks(const Node& node, Scene& scene, const SceneNames& names);
/// Reads the joints of bones, and adds the joints of heads to those of the scene.
void read_joints(const Node& node, Scene& scene, const SceneNames& names);
HeadTemplate::Joint read_joint(const Node& node);
void read_time(const Node& node, SceneTime& time);
void read_accuracy(const Node& node, const SceneOptions& options, Scene& scene, const SceneNames& names);
/// Must be called after read_constraints(), which names the bones.
void read_bone_centres(const Node& node, Scene& scene, const SceneNames& names);
/// Reads `action_units`, which may name a file with action units and expressions, then `expressions`.
void read_expressions(const Node& action_units, const Node& expressions, Scene& scene, SceneNames& names);
void read_demo(const Node& node, Scene& scene, const SceneNames& names);

/// Reads {lower: [x, y, z], upper: [x, y, z]}. One of the two lists may be missing, and numbers may be null.
Region read_region(const Node& node);

/// Reads the mapping in a YAML file. Throws Error if this fails; messages use `what` and `expected`.
YAML::Node load_yaml(const std::string& path, const std::string& what, const std::string& expected);

/// Reads a length [m]; 0 if the value is absent or wrong.
double read_length(const Node& node, const Bound& bound = positive);
/// Reads the name of a length unit and returns the unit [m]; `fallback` if the value is absent or wrong.
double read_length_unit(const Node& node, double fallback);

/// Returns the only one of `keys` that the mapping has. If it has none or several, records a fault, accepts all keys
/// and returns an empty text.
std::string one_of(const Node& entry, Mapping& mapping, const std::vector<std::string>& keys);

/// Reads the key `name` of a list entry, which must differ from the `earlier` names, and adds it to them.
std::string read_unique_name(Mapping& mapping, std::vector<std::string>& earlier);

/// Reads a section whose keys are the names of its items, and adds these to `names`. read(entry, mapping, item) reads
/// all fields of an item except its name and line.
template <class Item, class Read>
void read_named(const Node& node, std::vector<Item>& items, Names& names, const Read& read)
{
  names.complete = node.is_mapping();
  for (const auto& [name, entry] : node.named_pairs())
  {
    Item item;
    item.name = name;
    item.line = entry.line();
    names.names.push_back(name);
    Mapping mapping(entry);
    read(entry, mapping, item);
    items.push_back(item);
  }
}

/// Reads a section that is a list of items with a key `name`. `read` is as for read_named().
template <class Item, class Read>
void read_list(const Node& node, std::vector<Item>& items, const Read& read)
{
  std::vector<std::string> earlier;
  for (const Node& entry : node.entries())
  {
    Item item;
    item.line = entry.line();
    Mapping mapping(entry);
    item.name = read_unique_name(mapping, earlier);
    read(entry, mapping, item);
    items.push_back(item);
  }
}

}  // namespace frontalis
