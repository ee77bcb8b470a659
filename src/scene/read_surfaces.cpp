#include "frontalis/scene/head_template.hpp"
#include "scene/sections.hpp"

#include <algorithm>
#include <filesystem>

namespace frontalis
{
namespace
{

double read_length(const Node& node) { return node.number(Dimension::length, positive, 0); }

// Folder of the mesh files. Its existence is checked when the first file is read, since shapes need no folder.
class MeshFolder
{
public:
  MeshFolder(const Node& node, const SceneOptions& options, const std::string& scene_file)
      : node_(node), folder_(std::filesystem::path(scene_file).parent_path())
  {
    if (!options.mesh_directory.empty())
      folder_ = options.mesh_directory;
    else if (const std::string text = node.text(); !text.empty())
      folder_ /= text;
    if (folder_.empty())
      folder_ = ".";
  }

  std::string resolve(const Node& file)
  {
    const std::string text = file.text();
    if (text.empty())
      return {};
    const std::filesystem::path path = folder_ / text;
    std::error_code ignored;
    if (!std::filesystem::is_directory(folder_, ignored) && !std::filesystem::path(text).is_absolute())
    {
      if (!reported_)
        node_.fault("no folder '" + folder_.string() + "'; must be a folder that holds the surface files");
      reported_ = true;
    }
    else if (std::filesystem::is_regular_file(path, ignored))
      any_there_ = true;
    else
      missing_.emplace_back(file, path.string());
    return path.string();
  }

  /// The template in a file, which all shapes that name the file share; null if it cannot be read.
  std::shared_ptr<const HeadTemplate> head(const Node& file)
  {
    const std::string path = resolve(file);
    std::error_code ignored;
    if (path.empty() || !std::filesystem::is_regular_file(path, ignored))
      return nullptr;
    const auto known = heads_.find(path);
    return known != heads_.end() ? known->second : heads_[path] = read_head_template(path);
  }

  /// Records one fault per missing file, or a single fault if all are missing, because then the folder is wrong.
  void report(const Node& surfaces) const
  {
    const std::string remedy = "; must be relative to the mesh directory '" + folder_.string() +
                               "', which mesh_dir or the option --mesh-dir sets";
    if (missing_.size() > 1 && !any_there_)
      surfaces.fault("none of the {} mesh files is there, the first being '{}'{}", missing_.size(), missing_[0].second,
                     remedy);
    else
      for (const auto& [file, path] : missing_)
        file.fault("no file '{}'{}", path, remedy);
  }

private:
  Node node_;
  std::filesystem::path folder_;
  std::vector<std::pair<Node, std::string>> missing_;
  std::map<std::string, std::shared_ptr<const HeadTemplate>> heads_;
  bool any_there_ = false;
  bool reported_ = false;
};

void read_forehead(Mapping& mapping, Shape& shape)
{
  shape.part = mapping.required("part", "a part of the forehead").choice(forehead_parts());
  for (const auto& [name, node] : mapping.optional("dimensions").named_pairs())
    shape.dimensions[name] = read_length(node);
}

void read_head(Mapping& mapping, MeshFolder& folder, Shape& shape)
{
  const Node file = mapping.required("template", "the YAML file of a head");
  const Node part = mapping.required("part", "a part of the head");
  for (const auto& [name, node] : mapping.optional("dimensions").named_pairs())
    shape.dimensions[name] = read_length(node);
  shape.head = folder.head(file);
  if (shape.head)
    shape.part = part.choice(shape.head->parts());
  else if (!file.faulty())
    part.text();
}

Shape read_shape(const Node& kind_node, Mapping& mapping, MeshFolder& folder)
{
  // in the order of Shape::Kind
  static const std::vector<std::string> kinds{ "box", "sphere", "ellipsoid", "cylinder", "torus", "forehead", "head" };
  const std::string name = kind_node.choice(kinds);
  Shape shape;
  if (name.empty())
  {
    mapping.ignore_rest();
    return shape;
  }
  shape.kind = static_cast<Shape::Kind>(std::find(kinds.begin(), kinds.end(), name) - kinds.begin());
  const std::string length = "a length greater than 0";
  if (shape.kind == Shape::Kind::forehead)
    read_forehead(mapping, shape);
  else if (shape.kind == Shape::Kind::head)
    read_head(mapping, folder, shape);
  else
    shape.centre = mapping.optional("centre").vector(Dimension::length, any_number, shape.centre);
  switch (shape.kind)
  {
    case Shape::Kind::box:
    case Shape::Kind::ellipsoid:
      shape.size = mapping.required("size", "three lengths").vector(Dimension::length, positive, shape.size);
      break;
    case Shape::Kind::cylinder:
      shape.length = read_length(mapping.required("length", length));
      [[fallthrough]];
    case Shape::Kind::torus:
      shape.axis = mapping.optional("axis").direction(shape.axis);
      [[fallthrough]];
    case Shape::Kind::sphere:
      shape.radius = read_length(mapping.required("radius", length));
      break;
    case Shape::Kind::forehead:
    case Shape::Kind::head:
      break;
  }
  if (shape.kind == Shape::Kind::torus)
  {
    const Node minor = mapping.required("minor_radius", length);
    shape.minor_radius = read_length(minor);
    if (shape.radius > 0 && shape.minor_radius >= shape.radius)
      minor.fault(minor.found() + "; must be less than the torus's radius");
  }
  shape.edge = read_length(mapping.optional("edge"));
  return shape;
}

}  // namespace

const std::vector<std::string>& forehead_parts()
{
  static const std::vector<std::string> parts{ "skin",
                                               "skull",
                                               "rim",
                                               "rim_upper",
                                               "rim_lower",
                                               "rim_lateral",
                                               "tissue",
                                               "frontalis_left",
                                               "frontalis_right",
                                               "corrugator_left",
                                               "corrugator_right",
                                               "procerus",
                                               "galea" };
  return parts;
}

void read_surfaces(const Node& node, const Node& mesh_directory, const SceneOptions& options, Scene& scene,
                   SceneNames& names)
{
  MeshFolder folder(mesh_directory, options, scene.file);
  const auto read = [&](const Node& entry, Mapping& mapping, Surface& surface)
  {
    surface.unit = node.context().length_unit;
    // ask only for the key that is present: messages about unknown keys list all keys that were asked for
    const bool shape = mapping.has("shape");
    if (shape == mapping.has("file"))
    {
      if (entry.is_mapping())
        entry.fault("found {} 'file' {} 'shape'; a surface has one of them", shape ? "both" : "neither",
                    shape ? "and" : "nor");
      mapping.ignore_rest();
    }
    else if (shape)
      surface.shape = read_shape(mapping.optional("shape"), mapping, folder);
    else
    {
      surface.file = folder.resolve(mapping.optional("file"));
      surface.unit = read_length_unit(mapping.optional("unit"), surface.unit);
      surface.subdivide = mapping.optional("subdivide").integer(0, 6, 0);
      static const std::vector<std::string> axes{ "x", "y", "z" };
      if (const std::string axis = mapping.optional("mirror").choice(axes); !axis.empty())
        surface.mirror = static_cast<int>(axis[0] - 'x');
    }
  };
  read_named(node, scene.surfaces, names.surfaces, read);
  folder.report(node);
}

}  // namespace frontalis
