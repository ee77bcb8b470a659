#include "frontalis/scene/head_template.hpp"
#include "frontalis/suggestion.hpp"
#include "scene/sections.hpp"

#include <algorithm>
#include <filesystem>

namespace frontalis
{
namespace
{

// What may be meant by the path of a file that is not there.
std::string alternative(const std::filesystem::path& path)
{
  if (path.string().find('\\') != std::string::npos)
    return " (write / between folders)";
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(path.parent_path(), ignored))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return suggestion(path.filename().string(), names);
}

// Folder of the mesh files. Its existence is checked when the first file is read, because shapes need no folder.
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

  /// The template in a file; null if it cannot be read. All shapes that name the file share the template.
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
        if (std::error_code ignored; std::filesystem::exists(path, ignored))
          file.fault("'{}' is no file but a folder or device{}", path, remedy);
        else
          file.fault("no file '{}'{}{}", path, alternative(path), remedy);
  }

private:
  Node node_;
  std::filesystem::path folder_;
  std::vector<std::pair<Node, std::string>> missing_;
  std::map<std::string, std::shared_ptr<const HeadTemplate>> heads_;
  bool any_there_ = false;
  bool reported_ = false;
};

/// The parts of a shape that an entry selects.
struct Parts
{
  bool many = false;                 ///< whether the entry is a set of surfaces
  std::vector<std::string> names;    ///< the parts in the set
  std::vector<std::string> muscles;  ///< the muscles in the set
};

/// Reads the key `parts` (`all` or names) or `part`. `known` is empty if the possible parts are unknown.
void read_parts(const Node& many, const Node& one, const std::string& whole, const std::vector<std::string>& known,
                const std::vector<std::string>& muscles, Shape& shape, Parts& parts)
{
  parts.many = many.given();
  if (many.given() && one.given())
    one.fault("stands beside 'parts'; a surface is one part, or a set of several");
  else if (!many.given() && !one.given())
    one.fault("missing; must be a part of the {}, or there must be 'parts'", whole);
  else if (known.empty())
    return;
  else if (one.given())
    shape.part = one.choice(known);
  else
    parts.names = many.is_text() && many.text() == "all" ? known : many.references({ "part", known, true });
  std::copy_if(parts.names.begin(), parts.names.end(), std::back_inserter(parts.muscles),
               [&](const std::string& name)
               { return std::find(muscles.begin(), muscles.end(), name) != muscles.end(); });
}

void read_dimensions(Mapping& mapping, Shape& shape)
{
  for (const auto& [name, node] : mapping.optional("dimensions").named_pairs())
    shape.dimensions[name] = read_length(node);
}

void read_forehead(Mapping& mapping, Shape& shape, Parts& parts)
{
  static const std::vector<std::string> muscles{ "frontalis_left", "frontalis_right", "corrugator_left",
                                                 "corrugator_right", "procerus" };
  const Node many = mapping.optional("parts");
  read_parts(many, mapping.optional("part"), "forehead", forehead_parts(), muscles, shape, parts);
  read_dimensions(mapping, shape);
}

// Reads a part, or parts, of a head. One that says nothing of its size has that of the head above it in the file.
void read_head(Mapping& mapping, MeshFolder& folder, const std::vector<Surface>& known, Shape& shape, Parts& parts)
{
  const bool sized = mapping.has("dimensions") || mapping.has("sex") || mapping.has("age") || mapping.has("tissue");
  const Node file = mapping.required("template", "the YAML file of a head");
  const Node many = mapping.optional("parts"), one = mapping.optional("part");
  read_dimensions(mapping, shape);
  const Node sex = mapping.optional("sex"), age = mapping.optional("age"), tissue = mapping.optional("tissue");
  shape.head = folder.head(file);
  const std::string of = sex.choice({ "male", "female" });
  for (const Surface& earlier : known)
    if (!sized && shape.head && earlier.shape && earlier.shape->head == shape.head)
    {
      shape.dimensions = earlier.shape->dimensions;
      shape.tissue = earlier.shape->tissue;
    }
  if (shape.head)
  {
    const auto names_of = [](const auto& presets)
    {
      std::vector<std::string> names;
      names.reserve(presets.size());
      for (const auto& preset : presets)
        names.push_back(preset.first);
      return names;
    };
    const std::string years = age.choice(names_of(shape.head->ages));
    const std::map<std::string, double> added =
        years.empty() ? std::map<std::string, double>() : shape.head->ages.at(years);
    for (const auto& d : shape.head->dimensions)
    {
      const auto change = added.find(d.name);
      if (!d.derived_from.empty() || (of.empty() && change == added.end()))
        continue;
      const double mean = of.empty() ? d.mean : of == "male" ? d.men : d.women;
      shape.dimensions.emplace(d.name, mean + (change == added.end() ? 0 : change->second));
    }
    if (const std::string depth = tissue.choice(names_of(shape.head->tissues)); !depth.empty())
      shape.tissue = shape.head->tissues.at(depth);
  }
  if (shape.head)
    read_parts(many, one, "head", shape.head->parts(), shape.head->muscle_parts(), shape, parts);
  else
    read_parts(many, one, "head", {}, {}, shape, parts);
}

/// Whether the ends of two curves lie in opposite directions.
bool run_against(const std::vector<Vector3>& a, const std::vector<Vector3>& b)
{
  double product = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    product += (a.back()[axis] - a.front()[axis]) * (b.back()[axis] - b.front()[axis]);
  return product < 0;
}

/// Reads a muscle between curves.
void read_muscle_shape(Mapping& mapping, Shape& shape)
{
  shape.thickness = read_length(mapping.required("thickness", "a length of at least 0"), not_negative);
  shape.ring = mapping.optional("ring").boolean(false);
  const Node curves = mapping.required("curves", "a list of at least two curves");
  const std::size_t least = shape.ring ? 3 : 2;
  for (const Node& curve : curves.entries())
  {
    std::vector<Vector3> points;
    for (const Node& point : curve.entries())
      points.push_back(point.vector(Dimension::length, any_number, {}));
    if (points.size() < least && !curve.faulty())
      curve.fault("found {} positions; must be at least {}", points.size(), least);
    if (points.size() >= least && !shape.ring && !shape.curves.empty() && shape.curves.back().size() >= least &&
        run_against(points, shape.curves.back()))
      curve.fault("runs against the curve before it; all curves must run in the same order, or the muscle is twisted");
    shape.curves.push_back(points);
  }
  if (shape.curves.size() < 2 && !curves.faulty())
    curves.fault("found {} curves; must be at least two", shape.curves.size());
}

/// Reads a surface at given depths below one of the surfaces `known`, which stand above it in the file.
void read_offset(Mapping& mapping, const std::vector<Surface>& known, Shape& shape)
{
  Names above{ "earlier surface", {}, true };
  for (const Surface& surface : known)
    above.names.push_back(surface.name);
  const std::string below = mapping.required("below", "the name of a closed surface").reference(above);
  for (const Surface& surface : known)
    if (surface.name == below)
      shape.below = std::make_shared<Surface>(surface);
  const Node depths = mapping.required("depths", "a list of places and depths");
  for (const Node& entry : depths.entries())
  {
    Shape::Depth site;
    Mapping fields(entry);
    site.at = fields.required("at", "a position").vector(Dimension::length, any_number, site.at);
    site.depth = read_length(fields.required("depth", "a length greater than 0"));
    shape.depths.push_back(site);
  }
  if (shape.depths.empty() && !depths.faulty())
    depths.fault("found no place; must be at least one");
}

Shape read_shape(const Node& kind_node, Mapping& mapping, MeshFolder& folder, const std::vector<Surface>& known,
                 Parts& parts)
{
  // The names of Shape::Kind, in its order.
  static const std::vector<std::string> kinds{ "box",      "sphere", "ellipsoid", "cylinder", "torus",
                                               "forehead", "head",   "muscle",    "offset" };
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
    read_forehead(mapping, shape, parts);
  else if (shape.kind == Shape::Kind::head)
    read_head(mapping, folder, known, shape, parts);
  else if (shape.kind == Shape::Kind::muscle)
    read_muscle_shape(mapping, shape);
  else if (shape.kind == Shape::Kind::offset)
    read_offset(mapping, known, shape);
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
    case Shape::Kind::muscle:
    case Shape::Kind::offset:
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
  Parts parts;
  const auto read = [&](const Node& entry, Mapping& mapping, Surface& surface)
  {
    surface.unit = node.context().length_unit;
    parts = {};
    // Only the key that is present is asked for, because messages about unknown keys list all keys that were asked for.
    const bool shape = mapping.has("shape");
    if (shape == mapping.has("file"))
    {
      if (entry.is_mapping())
        entry.fault("found {} 'file' {} 'shape'; a surface has one of them", shape ? "both" : "neither",
                    shape ? "and" : "nor");
      mapping.ignore_rest();
    }
    else if (shape)
      surface.shape = read_shape(mapping.optional("shape"), mapping, folder, scene.surfaces, parts);
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
  const auto entries = node.named_pairs();
  names.surfaces.complete = node.is_mapping();
  for (const auto& [name, entry] : entries)
  {
    Surface surface;
    surface.name = name;
    surface.line = entry.line();
    {
      Mapping mapping(entry);
      read(entry, mapping, surface);
    }
    if (!parts.many)
    {
      scene.surfaces.push_back(surface);
      names.surfaces.names.push_back(name);
      continue;
    }
    names.surfaces.complete = names.surfaces.complete && !parts.names.empty();
    names.muscle_sets[name] = parts.muscles;
    if (surface.shape->head)
      names.heads[name] = *surface.shape;
    for (const std::string& part : parts.names)
    {
      // An entry with the name of a part replaces that part of the set.
      if (std::any_of(entries.begin(), entries.end(), [&](const auto& other) { return other.first == part; }))
        continue;
      if (names.surfaces.has(part))
      {
        entry.fault("its part '{}' is a surface already; name those 'parts' that are meant", part);
        continue;
      }
      surface.name = surface.shape->part = part;
      scene.surfaces.push_back(surface);
      names.surfaces.names.push_back(part);
    }
  }
  folder.report(node);
}

}  // namespace frontalis
