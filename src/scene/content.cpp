#include "scene/content.hpp"

#include "scene/quantity.hpp"

#include "frontalis/error.hpp"
#include "frontalis/scene/content_hash.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <vector>

namespace frontalis
{
namespace
{

std::string hash_of_file(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw Error(path + ": cannot be read; must be a readable mesh file");
  ContentHash hash;
  std::vector<char> buffer(std::size_t{ 1 } << 20);
  while (file.read(buffer.data(), static_cast<std::streamsize>(buffer.size())), file.gcount() > 0)
    hash.add(buffer.data(), static_cast<std::size_t>(file.gcount()));
  if (file.bad())
    throw Error(path + ": reading failed; must be a readable mesh file");
  return hash.text();
}

// one line of words, each after a blank; texts carry their length, so that different scenes give different lines
class Line
{
public:
  Line(std::string& content, const std::string& kind) : content_(content) { content_ += kind; }
  ~Line() { content_ += '\n'; }
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;

  Line& add(double value)
  {
    content_ += ' ' + number_text(value);
    return *this;
  }
  Line& add(const std::string& text)
  {
    content_ += fmt::format(" {}:{}", text.size(), text);
    return *this;
  }
  Line& add(const Vector3& vector) { return add(vector[0]).add(vector[1]).add(vector[2]); }
  Line& add(const Region& region) { return add(region.lower).add(region.upper); }
  Line& add(const std::vector<std::string>& texts)
  {
    add(static_cast<double>(texts.size()));
    for (const std::string& text : texts)
      add(text);
    return *this;
  }
  Line& add(const std::vector<Vector3>& vectors)
  {
    add(static_cast<double>(vectors.size()));
    for (const Vector3& vector : vectors)
      add(vector);
    return *this;
  }
  Line& add(const std::map<std::string, double>& numbers)
  {
    add(static_cast<double>(numbers.size()));
    for (const auto& [name, value] : numbers)
      add(name).add(value);
    return *this;
  }

private:
  std::string& content_;
};

void add_surface(const Surface& surface, std::string& content)
{
  Line line(content, "surface");
  line.add(surface.name);
  if (!surface.shape)
  {
    // the extension decides which format the bytes are in
    line.add("file").add(std::filesystem::path(surface.file).extension().string());
    line.add(surface.unit).add(hash_of_file(surface.file));
    return;
  }
  const Shape& shape = *surface.shape;
  line.add("shape").add(static_cast<double>(shape.kind)).add(shape.centre).add(shape.size).add(shape.axis);
  line.add(shape.radius).add(shape.minor_radius).add(shape.length).add(shape.edge);
  line.add(shape.part).add(shape.dimensions);
}

void add_muscle(const SceneMuscle& muscle, std::string& content)
{
  Line line(content, "muscle");
  line.add(muscle.name).add(muscle.volume).add(muscle.fibre);
  line.add(muscle.stress_reference).add(muscle.passive).add(muscle.tension_length);
  line.add(muscle.rise_time).add(muscle.fall_time);
  for (const MuscleEnd& end : { muscle.origin, muscle.insertion })
    line.add(end.surface).add(end.points);
  line.add(muscle.ring ? (*muscle.ring ? "ring" : "open") : "");
  if (muscle.net)
  {
    line.add(muscle.net->size[0]).add(muscle.net->size[1]).add(muscle.net->size[2]).add(muscle.net->ring);
    line.add(muscle.net->points).add(static_cast<double>(muscle.net->weights.size()));
    for (const double weight : muscle.net->weights)
      line.add(weight);
  }
}

void add_anatomy(const Scene& scene, std::string& content)
{
  for (const Surface& surface : scene.surfaces)
    add_surface(surface, content);
  for (const Volume& volume : scene.volumes)
  {
    Line line(content, "volume");
    line.add(volume.name).add(volume.closed_by).add(volume.inside).add(volume.outside).add(volume.without);
    line.add(volume.within).add(volume.depth_min).add(volume.depth_max).add(volume.crop);
    line.add(volume.material).add(volume.priority).add(volume.tissue);
  }
  for (const SceneMaterial& material : scene.materials)
  {
    Line line(content, "material");
    line.add(material.name).add(material.law).add(material.density).add(material.parameters);
    line.add(material.families[0]).add(material.families[1]).add(material.along);
    for (const auto& term : material.viscosity)
      line.add(term.share).add(term.time);
  }
  for (const Layer& layer : scene.layers)
    Line(content, "layer")
        .add(layer.name)
        .add(layer.surface)
        .add(layer.volume)
        .add(layer.material)
        .add(layer.thickness);
  for (const SceneMuscle& muscle : scene.muscles)
    add_muscle(muscle, content);
}

void add_restrictions(const Scene& scene, std::string& content)
{
  for (const SceneConstraint& constraint : scene.constraints)
  {
    Line line(content, "constraint");
    line.add(constraint.name).add(static_cast<double>(constraint.kind)).add(constraint.surfaces);
    line.add(constraint.within).add(constraint.crop).add(constraint.bone).add(constraint.friction);
    if (!constraint.on.empty())
      line.add(constraint.on);
  }
  for (const SceneLoad& load : scene.loads)
  {
    Line line(content, "load");
    line.add(load.name).add(static_cast<double>(load.kind)).add(load.surface).add(load.value);
    line.add(load.fixed[0]).add(load.fixed[1]).add(load.fixed[2]);
    line.add(load.within).add(load.ramp).add(load.crop);
  }
  Line(content, "gravity").add(scene.gravity);
  Line(content, "switched off").add(names_of(scene.switched_off));
}

void add_output(const Scene& scene, std::string& content)
{
  Line(content, "skin").add(scene.skin.surface).add(scene.skin.crop).add(scene.skin.extrapolation);
  for (const SceneLandmark& landmark : scene.landmarks)
    Line(content, "landmark").add(landmark.name).add(landmark.position);
  Line(content, "frame").add(scene.frame.id).add(scene.frame.origin).add(scene.frame.forward).add(scene.frame.up);
  for (const auto& [name, activation] : scene.expressions)
    Line(content, "expression").add(name).add(activation);
  for (const DemoPhase& phase : scene.demo)
    Line(content, "demo").add(phase.expression).add(phase.ramp).add(phase.seconds);
}

void add_numerics(const Scene& scene, std::string& content)
{
  Line(content, "time")
      .add(scene.time.damping)
      .add(scene.time.scaling)
      .add(scene.time.frame_rate)
      .add(scene.time.activation_slew);
  const AccuracyProfile& profile = scene.accuracy;
  Line(content, "accuracy")
      .add(profile.voxel)
      .add(profile.samples)
      .add(profile.fill_min)
      .add(profile.time_step_share)
      .add(static_cast<double>(profile.mass_scaling.kind))
      .add(profile.mass_scaling.factor)
      .add(profile.mass_scaling.time_step)
      .add(profile.assumed_strain ? 1 : 0)
      .add(profile.integration)
      .add(profile.precision)
      .add(profile.time_step)
      .add(profile.mass_scaling.materials);
  Line(content, "profile").add(profile.name);
  for (const AccuracyProfile& known : scene.profiles)
    Line(content, "measured")
        .add(known.name)
        .add(known.measured.error)
        .add(known.measured.cost)
        .add(known.measured.machine);
}

}  // namespace

std::string canonical_content(const Scene& scene)
{
  std::string content = "frontalis scene content 1\n";
  add_anatomy(scene, content);
  add_restrictions(scene, content);
  add_output(scene, content);
  add_numerics(scene, content);
  return content;
}

}  // namespace frontalis
