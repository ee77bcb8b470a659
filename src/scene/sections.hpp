#pragma once

#include "scene/yaml_reader.hpp"

#include "frontalis/scene/read_scene.hpp"
#include "frontalis/scene/scene.hpp"

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
  Names expressions{ "expression", { "relax" }, true };
};

// one function per section, in the order of the calls; each takes the section's node, given or not
void read_frame(const Node& node, FaceFrame& frame);
void read_surfaces(const Node& node, const Node& mesh_directory, const SceneOptions& options, Scene& scene,
                   SceneNames& names);
void read_materials(const Node& node, Scene& scene, SceneNames& names);
void read_volumes(const Node& node, Scene& scene, SceneNames& names);
void read_layers(const Node& node, Scene& scene, const SceneNames& names);
void read_muscles(const Node& node, Scene& scene, SceneNames& names);
void read_constraints(const Node& node, Scene& scene, const SceneNames& names);
void read_loads(const Node& node, Scene& scene, const SceneNames& names);
/// After everything that effects come from.
void read_effects(const Node& node, Scene& scene);
void read_skin(const Node& node, SceneSkin& skin, const SceneNames& names);
void read_landmarks(const Node& node, Scene& scene);
void read_time(const Node& node, SceneTime& time);
void read_accuracy(const Node& node, const SceneOptions& options, Scene& scene, const SceneNames& names);
void read_expressions(const Node& node, Scene& scene, SceneNames& names);
void read_demo(const Node& node, Scene& scene, const SceneNames& names);

/// {lower: [x, y, z], upper: [x, y, z]}, either of them and each number optional.
Region read_region(const Node& node);

/// The mapping of a file that holds a `what`. Throws Error: no such file, not YAML, not what is expected.
YAML::Node load_yaml(const std::string& path, const std::string& what, const std::string& expected);

/// The `name` of a list's entry, which must differ from the earlier ones; adds it to them.
std::string read_unique_name(Mapping& mapping, std::vector<std::string>& earlier);

}  // namespace frontalis
