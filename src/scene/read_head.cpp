#include "frontalis/scene/head_template.hpp"

#include "frontalis/error.hpp"
#include "scene/sections.hpp"

#include <algorithm>
#include <filesystem>

namespace frontalis
{
namespace
{

double read_length(const Node& node, const Bound& bound = positive) { return node.number(Dimension::length, bound, 0); }

Vector3 read_place(const Node& node) { return node.vector(Dimension::length, any_number, { 0, 0, 0 }); }

/// Reads a file that the template names, beside it: calls read(root) and hands its faults on.
template <class Read>
void read_beside(const Node& name, HeadTemplate& head, const Read& read)
{
  const std::string text = name.text();
  if (text.empty())
    return;
  const std::string path = (std::filesystem::path(head.file).parent_path() / text).string();
  head.files.push_back(path);
  const YAML::Node yaml = load_yaml(path, "head", "a mapping");
  ReadingContext context{ Faults(path), head.unit };
  read(Node(yaml, "", 1, context));
  if (!context.faults.empty())
    throw Error(context.faults.text());
}

void read_dimension(const std::string& name, const Node& node, const Names& landmarks, HeadTemplate& head)
{
  HeadTemplate::Dimension dimension;
  dimension.name = name;
  Mapping mapping(node);
  if (mapping.has("across"))
    dimension.from = mapping.optional("across").reference(landmarks);
  else
  {
    const Node between = mapping.required("between", "two landmarks, or 'across' with one");
    const std::vector<std::string> ends = between.references(landmarks);
    if (ends.size() != 2 && !between.faulty())
      between.fault("found {} landmarks; must be two", ends.size());
    else if (ends.size() == 2)
    {
      dimension.from = ends[0];
      dimension.to = ends[1];
    }
  }
  dimension.mean = read_length(mapping.required("mean", "a length greater than 0"));
  dimension.deviation = read_length(mapping.required("sd", "a length greater than 0"));
  Names earlier{ "dimension", {}, true };
  for (const auto& d : head.dimensions)
    earlier.names.push_back(d.name);
  if (mapping.has("derived"))
    dimension.derived_from = mapping.optional("derived").references(earlier);
  head.dimensions.push_back(dimension);
}

void read_depths(const Node& root, HeadTemplate& head)
{
  Mapping mapping(root);
  for (const Node& entry : mapping.required("depths", "a list of places and depths").entries())
  {
    HeadTemplate::DepthSite site;
    Mapping fields(entry);
    site.name = fields.required("name", "a name").name();
    site.at = read_place(fields.required("at", "a position"));
    site.depth = read_length(fields.required("depth", "a length greater than 0"));
    const Node direction = fields.optional("direction");
    if (direction.given())
      site.direction = direction.direction({ 0, 0, 0 });
    head.depths.push_back(site);
  }
}

HeadTemplate::Curve read_curve(const Node& node)
{
  HeadTemplate::Curve curve;
  Mapping fields(node);
  const Node points = fields.required("points", "a list of at least two positions");
  for (const Node& point : points.entries())
    curve.points.push_back(read_place(point));
  if (curve.points.size() < 2 && !points.faulty())
    points.fault("found {} positions; must be at least two", curve.points.size());
  curve.depth = fields.required("depth", "a proportion of the soft tissue").number(Dimension::number, proportion, 0.5);
  return curve;
}

void read_muscle(const std::string& name, const Node& node, HeadTemplate& head)
{
  HeadTemplate::Muscle muscle;
  muscle.name = name;
  Mapping fields(node);
  muscle.sided = fields.optional("sided").boolean(true);
  muscle.ring = fields.optional("ring").boolean(false);
  muscle.thickness = read_length(fields.required("thickness", "a length greater than 0"));
  const Node curves = fields.required("curves", "a list of at least two curves");
  for (const Node& curve : curves.entries())
    muscle.curves.push_back(read_curve(curve));
  if (muscle.curves.size() < 2 && !curves.faulty())
    curves.fault("found {} curves; must be at least two", muscle.curves.size());
  head.muscles.push_back(muscle);
}

void read_root(const Node& root, HeadTemplate& head)
{
  Mapping mapping(root);
  head.unit = read_length_unit(mapping.required("unit", "a length unit"), 1);
  root.context().length_unit = head.unit;
  const std::string cage = mapping.required("cage", "an OBJ file").text();
  head.cage = (std::filesystem::path(head.file).parent_path() / cage).string();
  head.files.push_back(head.cage);
  const Node eye_node = mapping.required("eye", "{centre, radius}");
  {
    Mapping eye(eye_node);
    head.eye = read_place(eye.required("centre", "a position"));
    head.eye_radius = read_length(eye.required("radius", "a length greater than 0"));
  }
  Names landmarks{ "landmark", {}, true };
  for (const auto& [name, node] : mapping.required("landmarks", "numbers of vertices by name").named_pairs())
  {
    head.landmarks[name] = node.integer(1, 1000000, 1) - 1;
    landmarks.names.push_back(name);
  }
  for (const auto& [name, node] : mapping.required("dimensions", "a mapping").named_pairs())
    read_dimension(name, node, landmarks, head);
  read_beside(mapping.required("bones", "a YAML file"), head, [&](const Node& node) { read_depths(node, head); });
  read_beside(mapping.required("muscles", "a YAML file"), head,
              [&](const Node& node)
              {
                for (const auto& [name, muscle] : node.named_pairs())
                  read_muscle(name, muscle, head);
              });
}

}  // namespace

std::vector<std::string> HeadTemplate::parts() const
{
  std::vector<std::string> names{ "skin",        "face",        "visible",  "skull",    "mandible",
                                  "teeth_upper", "teeth_lower", "eye_left", "eye_right" };
  const std::vector<std::string> others = muscle_parts();
  names.insert(names.end(), others.begin(), others.end());
  return names;
}

std::vector<std::string> HeadTemplate::muscle_parts() const
{
  std::vector<std::string> names;
  for (const Muscle& muscle : muscles)
    if (muscle.sided)
    {
      names.push_back(muscle.name + "_left");
      names.push_back(muscle.name + "_right");
    }
    else
      names.push_back(muscle.name);
  return names;
}

std::shared_ptr<const HeadTemplate> read_head_template(const std::string& path)
{
  auto head = std::make_shared<HeadTemplate>();
  head->file = path;
  head->files = { path };
  const YAML::Node yaml =
      load_yaml(path, "head", "a mapping with unit, cage, eye, landmarks, dimensions, bones, muscles");
  ReadingContext context{ Faults(path), 1 };
  read_root(Node(yaml, "", 1, context), *head);
  if (!context.faults.empty())
    throw Error(context.faults.text());
  return head;
}

}  // namespace frontalis
