#include "scene/quantity.hpp"

#include "frontalis/content_hash.hpp"
#include "frontalis/scene/head_template.hpp"
#include "frontalis/scene/read_scene.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <type_traits>

namespace frontalis
{
namespace
{

std::string hash_of_file(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw Error(path + ": cannot be read; must be a readable mesh file");
  std::ostringstream bytes;
  bytes << file.rdbuf();
  if (bytes.bad())
    throw Error(path + ": reading failed; must be a readable mesh file");
  return content_hash(bytes.str());
}

/// Collects lines of values, with a blank before each value. Strings are written with their length, so that different
/// scenes give different lines.
class Content
{
public:
  template <class... Words>
  void line(const char* kind, const Words&... words)
  {
    text_ += '\n';
    text_ += kind;
    add(words...);
  }
  /// Appends values to the last line.
  template <class... Words>
  void add(const Words&... words)
  {
    (put(words), ...);
  }
  std::string text() const { return text_ + '\n'; }

private:
  void put(double value) { text_ += ' ' + number_text(value); }
  void put(const std::string& text) { text_ += fmt::format(" {}:{}", text.size(), text); }
  void put(const BonePose& pose)
  {
    add(pose.bone, pose.shift, pose.turn);
    if (pose.angle != 0)
      add("angle", pose.angle);
  }
  void put(const Region& region) { add(region.lower, region.upper); }
  template <class Kind, class = std::enable_if_t<std::is_enum_v<Kind>>>
  void put(Kind kind)
  {
    put(static_cast<double>(kind));
  }
  template <class Value>
  void put(const std::array<Value, 3>& values)
  {
    add(values[0], values[1], values[2]);
  }
  template <class Value>
  void put(const std::vector<Value>& values)
  {
    put(static_cast<double>(values.size()));
    for (const Value& value : values)
      put(value);
  }
  void put(const std::map<std::string, double>& numbers)
  {
    put(static_cast<double>(numbers.size()));
    for (const auto& [name, value] : numbers)
      add(name, value);
  }

  std::string text_ = "frontalis scene content 1";
};

void add_surface(const Surface& surface, Content& content)
{
  content.line("surface", surface.name);
  if (!surface.shape)
  {
    // The extension of the file name determines the mesh format.
    content.add("file", std::filesystem::path(surface.file).extension().string(), surface.unit,
                hash_of_file(surface.file));
    if (surface.subdivide > 0 || surface.mirror >= 0)
      content.add("subdivide", surface.subdivide, surface.mirror);
    return;
  }
  const Shape& shape = *surface.shape;
  content.add("shape", shape.kind, shape.centre, shape.size, shape.axis, shape.radius, shape.minor_radius, shape.length,
              shape.edge, shape.part, shape.dimensions);
  if (shape.head)
    for (const std::string& file : shape.head->files)
      content.add(hash_of_file(file));
  if (shape.tissue != 1)
    content.add("tissue", shape.tissue);
  if (shape.kind == Shape::Kind::muscle)
    content.add(shape.curves, shape.ring ? "ring" : "strap", shape.thickness);
  for (const auto& site : shape.depths)
    content.add(site.at, site.depth);
  if (shape.below)
    add_surface(*shape.below, content);
}

void add_muscle(const SceneMuscle& muscle, Content& content)
{
  content.line("muscle", muscle.name, muscle.volume, muscle.fibre, muscle.stress_reference, muscle.passive,
               muscle.tension_length, muscle.rise_time, muscle.fall_time, muscle.cross_section, muscle.tone);
  for (const MuscleEnd& end : { muscle.origin, muscle.insertion })
    content.add(end.surface, end.points);
  content.add(muscle.ring ? (*muscle.ring ? "ring" : "open") : "");
  if (muscle.net)
    content.add(muscle.net->size, muscle.net->ring, muscle.net->points, muscle.net->weights);
}

void add_anatomy(const Scene& scene, Content& content)
{
  for (const Surface& surface : scene.surfaces)
    add_surface(surface, content);
  for (const Volume& v : scene.volumes)
    content.line("volume", v.name, v.closed_by, v.inside, v.outside, v.without, v.within, v.depth_min, v.depth_max,
                 v.crop, v.material, v.priority, v.tissue, v.slits);
  for (const SceneMaterial& material : scene.materials)
  {
    content.line("material", material.name, material.law, material.density, material.parameters, material.families[0],
                 material.families[1], material.along);
    if (!material.about.empty())
      content.add(material.about, material.angle);
    for (const auto& term : material.viscosity)
      content.add(term.share, term.time);
  }
  for (const Layer& layer : scene.layers)
    content.line("layer", layer.name, layer.surface, layer.volume, layer.material, layer.thickness, layer.shell);
  for (const SceneMuscle& muscle : scene.muscles)
    add_muscle(muscle, content);
  for (const SceneWeakness& w : scene.weakness)
    content.line("weakness", w.muscles, w.keeps, w.centre, w.radius, w.dose);
}

void add_restrictions(const Scene& scene, Content& content)
{
  for (const SceneConstraint& c : scene.constraints)
  {
    content.line("constraint", c.name, c.kind, c.surfaces, c.within, c.of, c.crop, c.bone, c.friction);
    if (!c.on.empty())
      content.add(c.on);
    if (c.pushed)
      content.add("pushed", c.pushed->mass, c.pushed->force, c.pushed->spring, c.pushed->damping);
  }
  for (const SceneLoad& load : scene.loads)
    content.line("load", load.name, load.kind, load.surface, load.value, load.fixed, load.within, load.ramp,
                 load.activated, load.crop, load.clear_of, load.clearance);
  content.line("gravity", scene.gravity);
  content.line("switched off", names_of(scene.switched_off));
}

void add_output(const Scene& scene, Content& content)
{
  content.line("skin", scene.skin.surface, scene.skin.crop, scene.skin.extrapolation);
  for (const SceneFilm& film : scene.films)
    content.line("film", film.material, film.thickness, film.base, film.stretch, film.crop);
  for (const SceneLandmark& landmark : scene.landmarks)
  {
    content.line("landmark", landmark.name, landmark.position);
    if (landmark.head)
      content.add(landmark.point.vertex, landmark.point.at, landmark.point.right, landmark.head->dimensions);
  }
  for (const SceneJoint& joint : scene.joints)
    content.line("joint", joint.bone, joint.joint.at, joint.joint.axis, joint.joint.slide);
  content.line("frame", scene.frame.id, scene.frame.origin, scene.frame.forward, scene.frame.up);
  for (const auto& [bone, centre] : scene.bone_centres)
    content.line("centre", bone, centre);
  for (const auto& [name, pose] : scene.action_units)
    content.line("action unit", name, pose.activation, pose.bones);
  for (const auto& [name, pose] : scene.expressions)
    content.line("expression", name, pose.activation, pose.bones);
  for (const DemoPhase& phase : scene.demo)
    content.line("demo", phase.expression, phase.ramp, phase.seconds, phase.bones);
}

void add_numerics(const Scene& scene, Content& content)
{
  content.line("time", scene.time.damping, scene.time.scaling, scene.time.frame_rate, scene.time.activation_slew);
  const AccuracyProfile& profile = scene.accuracy;
  const MassScaling& scaling = profile.mass_scaling;
  content.line("accuracy", profile.voxel, profile.samples, profile.fill_min, profile.time_step_share, scaling.kind,
               scaling.factor, scaling.time_step, scaling.in_motion, profile.bulk_modulus_max, profile.assumed_strain,
               profile.integration, profile.precision, profile.time_step, profile.boundary, profile.fibres,
               profile.gaps, scaling.materials);
  content.line("profile", profile.name);
  for (const AccuracyProfile& known : scene.profiles)
    content.line("measured", known.name, known.measured.error, known.measured.cost, known.measured.machine);
}

}  // namespace

// Returns the content of a scene as text, with numbers in SI units. A hash of the file's bytes replaces the path of
// each mesh file. Line numbers and the settings of profiles that are not chosen are left out.
std::string content_of(const Scene& scene)
{
  Content content;
  add_anatomy(scene, content);
  add_restrictions(scene, content);
  add_output(scene, content);
  add_numerics(scene, content);
  return content.text();
}

}  // namespace frontalis
