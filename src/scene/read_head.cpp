#include "frontalis/scene/head_template.hpp"

#include "frontalis/error.hpp"
#include "frontalis/physics/number.hpp"
#include "scene/sections.hpp"

#include <algorithm>
#include <filesystem>

namespace frontalis
{
namespace
{

Vector3 read_place(const Node& node) { return node.vector(Dimension::length, any_number, { 0, 0, 0 }); }

/// Reads a file that the template names and that lies in the same folder: calls read(root) and passes on its faults.
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
  const auto mean_and_deviation = [&](const std::string& sex) -> std::pair<double, double>
  {
    const auto pair = mapping.required(sex, "[mean, standard deviation]").entries();
    return { pair.empty() ? 1 : read_length(pair.front()), pair.empty() ? 1 : read_length(pair.back()) };
  };
  const auto [men, men_deviation] = mean_and_deviation("men");
  const auto [women, women_deviation] = mean_and_deviation("women");
  dimension.men = men;
  dimension.women = women;
  dimension.mean = 0.5 * (men + women);
  dimension.deviation = 0.5 * (men_deviation + women_deviation);
  Names earlier{ "dimension", {}, true };
  for (const auto& d : head.dimensions)
    earlier.names.push_back(d.name);
  if (mapping.has("derived"))
    dimension.derived_from = mapping.optional("derived").references(earlier);
  head.dimensions.push_back(dimension);
}

void read_presets(const Node& node, HeadTemplate& head)
{
  Mapping presets(node);
  for (const auto& [age, changes] : presets.optional("age").named_pairs())
  {
    auto& added = head.ages[age];
    Mapping mapping(changes);
    for (const auto& d : head.dimensions)
      if (d.derived_from.empty() && mapping.has(d.name))
        added[d.name] = read_length(mapping.optional(d.name), any_number);
  }
  for (const auto& [name, factor] : presets.optional("tissue").named_pairs())
    head.tissues[name] = factor.number(Dimension::number, positive, 1);
}

double read_coordinate(const Node& node, double fallback)
{
  return node.number(Dimension::length, any_number, fallback);
}

/// Points of an outline, which have the two coordinates in its plane.
std::vector<Vector3> read_flat_points(const Node& list)
{
  std::vector<Vector3> points;
  for (const Node& point : list.entries())
  {
    const auto pair = point.entries();
    if (pair.size() != 2)
      point.fault("found {} numbers; must be two", pair.size());
    else
      points.push_back({ read_coordinate(pair[0], 0), read_coordinate(pair[1], 0), 0 });
  }
  return points;
}

void read_outline(const Node& node, HeadTemplate::Solid& solid)
{
  Mapping fields(node);
  static const std::vector<std::string> axes{ "x", "y", "z" };
  if (const std::string axis = fields.required("across", "x, y or z").choice(axes); !axis.empty())
    solid.axis = axis[0] - 'x';
  solid.points = read_flat_points(fields.required("points", "a list of positions in the plane"));
  if (solid.points.size() < 3)
    node.fault("found {} points; must be at least three", solid.points.size());
  solid.from = read_coordinate(fields.optional("from"), solid.from);
  solid.to = read_coordinate(fields.optional("to"), solid.to);
  if (const Node apex = fields.optional("apex"); apex.given())
  {
    solid.centre = read_place(apex);
    solid.depth = read_coordinate(fields.required("at", "the plane of the points"), 0) - solid.centre[solid.axis];
  }
}

HeadTemplate::Solid read_solid(const Node& entry)
{
  using Kind = HeadTemplate::Solid::Kind;
  // The names of Solid::Kind, in its order.
  static const std::vector<std::string> kinds{ "below", "above", "ellipsoid", "outline", "tube", "teeth" };
  HeadTemplate::Solid solid;
  Mapping mapping(entry);
  const std::string kind = one_of(entry, mapping, kinds);
  if (kind.empty())
    return solid;
  solid.kind = static_cast<Kind>(std::find(kinds.begin(), kinds.end(), kind) - kinds.begin());
  const Node node = mapping.optional(kind);
  if (solid.kind == Kind::below || solid.kind == Kind::above)
  {
    solid.depth = read_length(node, not_negative);
    return solid;
  }
  if (solid.kind == Kind::outline)
  {
    read_outline(node, solid);
    return solid;
  }
  Mapping fields(node);
  if (solid.kind == Kind::ellipsoid)
  {
    solid.centre = read_place(fields.required("centre", "a position"));
    solid.axes = fields.required("axes", "three semi-axes").vector(Dimension::length, positive, { 1, 1, 1 });
    return solid;
  }
  const Node points = fields.required("points", "a list of positions");
  if (solid.kind == Kind::teeth)
    solid.points = read_flat_points(points);
  else
    for (const Node& point : points.entries())
      solid.points.push_back(read_place(point));
  if (solid.points.size() < 2 && !points.faulty())
    points.fault("found {} positions; must be at least two", solid.points.size());
  if (solid.kind == Kind::tube)
  {
    const Node radii = fields.required("radii", "as many lengths as points");
    for (const Node& radius : radii.entries())
      solid.sizes.push_back({ read_length(radius), 0, 0 });
    if (solid.sizes.size() != solid.points.size() && !radii.faulty())
      radii.fault("found {} radii; must be as many as points, {}", solid.sizes.size(), solid.points.size());
    return solid;
  }
  solid.to = read_coordinate(fields.required("edge", "a height"), 0);
  solid.from = read_coordinate(fields.required("neck", "a height"), 0);
  for (const Node& size : fields.required("sizes", "a list of [width, at the edge, at the neck]").entries())
    solid.sizes.push_back(size.vector(Dimension::length, positive, { 1, 1, 1 }));
  return solid;
}

void read_built(const Node& node, HeadTemplate::Built& built)
{
  using Kind = HeadTemplate::BoneStep::Kind;
  static const std::vector<std::string> kinds{ "add", "cut", "keep" };  // names of BoneStep::Kind, in its order
  for (const auto& [name, list] : node.named_pairs())
  {
    auto& steps = built.emplace_back(name, std::vector<HeadTemplate::BoneStep>()).second;
    for (const Node& entry : list.entries())
    {
      HeadTemplate::BoneStep step;
      Mapping fields(entry);
      const std::string kind = one_of(entry, fields, kinds);
      if (kind.empty())
        continue;
      step.kind = static_cast<Kind>(std::find(kinds.begin(), kinds.end(), kind) - kinds.begin());
      const Node solids = fields.optional(kind);
      for (const Node& solid : solids.is_list() ? solids.entries() : std::vector<Node>{ solids })
        step.solids.push_back(read_solid(solid));
      step.round = read_length(fields.optional("round"), not_negative);
      steps.push_back(step);
    }
  }
}

void read_bones(const Node& root, HeadTemplate& head)
{
  Mapping mapping(root);
  read_built(mapping.required("bones", "a mapping"), head.bones);
  read_built(mapping.optional("bodies"), head.bodies);
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
  if (fields.has("below"))
    curve.below = read_length(fields.optional("below"));
  else
    curve.depth =
        fields.required("depth", "a proportion of the soft tissue").number(Dimension::number, proportion, 0.5);
  return curve;
}

void read_muscle(const std::string& name, const Node& node, HeadTemplate& head)
{
  HeadTemplate::Muscle muscle;
  muscle.name = name;
  Mapping fields(node);
  muscle.sided = fields.optional("sided").boolean(true);
  muscle.ring = fields.optional("ring").boolean(false);
  muscle.pad = fields.optional("pad").boolean(false);
  muscle.thickness = read_length(fields.required("thickness", "a length greater than 0"));
  const Node curves = fields.required("curves", "a list of at least two curves");
  for (const Node& curve : curves.entries())
    muscle.curves.push_back(read_curve(curve));
  if (muscle.curves.size() < 2 && !curves.faulty())
    curves.fault("found {} curves; must be at least two", muscle.curves.size());
  head.muscles.push_back(muscle);
}

/// Reads landmarks that are vertices of the cage, in the midline or on the left side.
void read_vertices(const Node& node, Names& landmarks, HeadTemplate& head)
{
  Mapping mapping(node);
  for (const char* key : { "midline", "left" })
    for (const auto& [name, number] : mapping.required(key, "numbers of vertices by name").named_pairs())
    {
      const int vertex = number.integer(1, 1000000, 1) - 1;
      head.landmarks[name] = vertex;
      landmarks.names.push_back(name);
      auto& points = head.points["anthropometric"];
      const bool sided = std::string(key) == "left";
      points.push_back({ name + (sided ? "_left" : ""), vertex, {}, false });
      if (sided)
        points.push_back({ name + "_right", vertex, {}, true });
    }
}

/// Reads a set of landmarks. An entry has a name, a number, or two numbers: those of the left point and of its mirror
/// image.
void read_points(const std::string& set, const Node& list, HeadTemplate& head)
{
  for (const Node& entry : list.entries())
  {
    Mapping fields(entry);
    HeadTemplate::Point point;
    point.at = read_place(fields.required("at", "a position"));
    const auto add = [&](const std::string& name)
    {
      point.name = name;
      head.points[set].push_back(point);
      point.right = true;
    };
    if (one_of(entry, fields, { "name", "number" }) == "name")
    {
      const std::string name = fields.optional("name").name();
      for (const char* side : { "_left", "_right" })
        add(name + side);
      if (point.at[1] == 0)
      {
        head.points[set].pop_back();
        head.points[set].back().name = name;
      }
      continue;
    }
    const Node numbers = fields.optional("number");
    for (const Node& number : numbers.is_list() ? numbers.entries() : std::vector<Node>{ numbers })
      add(fmt::format("{}_{}", set, number.integer(1, 1000, 1)));
  }
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
  read_vertices(mapping.required("landmarks", "{midline, left}"), landmarks, head);
  for (const auto& [name, node] : mapping.required("dimensions", "a mapping").named_pairs())
    read_dimension(name, node, landmarks, head);
  read_presets(mapping.optional("presets"), head);
  read_beside(mapping.required("bones", "a YAML file"), head, [&](const Node& node) { read_bones(node, head); });
  for (const auto& [bone, node] : mapping.optional("joints").named_pairs())
    head.joints[bone] = read_joint(node);
  if (const Node points = mapping.optional("points"); points.given())
    read_beside(points, head,
                [&](const Node& node)
                {
                  for (const auto& [set, list] : node.named_pairs())
                    read_points(set, list, head);
                });
  read_beside(mapping.required("muscles", "a YAML file"), head,
              [&](const Node& node)
              {
                for (const auto& [name, muscle] : node.named_pairs())
                  read_muscle(name, muscle, head);
              });
}

}  // namespace

HeadTemplate::Joint read_joint(const Node& node)
{
  HeadTemplate::Joint joint;
  Mapping fields(node);
  joint.at = read_place(fields.required("at", "a position"));
  joint.axis = fields.required("axis", "a direction").direction(joint.axis);
  // Lengths are per degree in the file and per radian in `joint`.
  joint.slide = fields.optional("slide").vector(Dimension::length, any_number, joint.slide);
  for (double& x : joint.slide)
    x *= 180 / physics::pi;
  return joint;
}

std::vector<std::string> HeadTemplate::parts() const
{
  std::vector<std::string> names{ "skin", "face", "visible", "mucosa", "eye_left", "eye_right" };
  for (const Built* built : { &bones, &bodies })
    for (const auto& [name, steps] : *built)
      names.push_back(name);
  for (const bool pads : { false, true })
    for (const std::string& name : muscle_parts(pads))
      names.push_back(name);
  return names;
}

std::vector<std::string> HeadTemplate::muscle_parts(bool pads) const
{
  std::vector<std::string> names;
  for (const Muscle& muscle : muscles)
    if (muscle.pad != pads)
      continue;
    else if (muscle.sided)
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
