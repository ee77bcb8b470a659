#include "frontalis/suggestion.hpp"
#include "scene/sections.hpp"

#include <algorithm>
#include <filesystem>

namespace frontalis
{
namespace
{

void read_voxel(const Node& node, Vector3& voxel)
{
  if (node.is_text())
  {
    const double edge = node.number(Dimension::length, positive, voxel[0]);
    voxel = { edge, edge, edge };
  }
  else if (node.given() && !node.is_list())
    node.fault(node.found() + "; must be a length or three lengths");
  else
    voxel = node.vector(Dimension::length, positive, voxel);
}

void read_mass_scaling(const Node& node, MassScaling& scaling, const SceneNames& names)
{
  if (!node.given() || node.is_null())
    return;
  if (node.is_text())
  {
    node.choice({ "none" });
    return;
  }
  Mapping mapping(node);
  const Node uniform = mapping.optional("uniform");
  const Node selective = mapping.optional("selective");
  const Node time_step = mapping.optional("time_step");
  const Node in_motion = mapping.optional("in_motion");
  if (node.is_mapping() && uniform.given() == (selective.given() || time_step.given()))
    node.fault(
        "found {} of uniform, selective, time_step; must be 'none', or have either uniform, or selective, time_step or "
        "both",
        uniform.given() ? "uniform and another" : "none");
  if (in_motion.given() && !uniform.given())
    in_motion.fault("found in_motion without uniform; must be beside uniform");
  if (uniform.given())
  {
    scaling.kind = MassScaling::Kind::uniform;
    scaling.factor = uniform.number(Dimension::number, at_least_one, 1);
  }
  if (selective.given() || time_step.given())
    scaling.kind = MassScaling::Kind::selective;
  scaling.materials = selective.references(names.materials);
  scaling.time_step = time_step.number(Dimension::time, positive, 0);
  scaling.in_motion = in_motion.number(Dimension::time, positive, 0);
}

AccuracyProfile read_profile(const std::string& name, const Node& node, const SceneNames& names)
{
  AccuracyProfile profile;
  profile.name = name;
  Mapping mapping(node);
  read_voxel(mapping.optional("voxel"), profile.voxel);
  profile.samples = mapping.optional("samples").integer(1, 32, profile.samples);
  profile.fill_min =
      mapping.optional("fill_min").number(Dimension::number, Bound{ 0, 1, true, false }, profile.fill_min);
  profile.time_step_share = mapping.optional("time_step_share")
                                .number(Dimension::number, Bound{ 0, 1, false, true }, profile.time_step_share);
  read_mass_scaling(mapping.optional("mass_scaling"), profile.mass_scaling, names);
  profile.bulk_modulus_max = mapping.optional("bulk_modulus_max").number(Dimension::pressure, positive, 0);
  std::string hourglass = "scalar";
  const auto choose = [&mapping](const std::string& key, const std::vector<std::string>& allowed, std::string& chosen)
  {
    if (const Node node_of_key = mapping.optional(key); node_of_key.given())
      chosen = node_of_key.choice(allowed);
  };
  choose("hourglass", { "scalar", "assumed_strain" }, hourglass);
  profile.assumed_strain = hourglass == "assumed_strain";
  choose("integration", { "one_point", "selective_reduced" }, profile.integration);
  choose("precision", { "single", "compensated", "double" }, profile.precision);
  choose("time_step", { "element", "assembled" }, profile.time_step);
  if (profile.mass_scaling.in_motion > 0 && profile.time_step != "assembled")
    node.fault("found mass_scaling with in_motion and 'time_step: {}'; must be with 'time_step: assembled'",
               profile.time_step);
  choose("boundary", { "staircase", "true" }, profile.boundary);
  choose("fibres", { "sampled", "spread" }, profile.fibres);
  choose("gaps", { "glued", "parted" }, profile.gaps);
  if (const Node node_of_key = mapping.optional("measured"); node_of_key.given())
  {
    Mapping measured(node_of_key);
    profile.measured.error = measured.required("error", "a length").number(Dimension::length, positive, 0);
    profile.measured.cost =
        measured.required("cost", "wall seconds per simulated second").number(Dimension::number, positive, 0);
    profile.measured.machine = measured.optional("machine").text();
  }
  return profile;
}

bool is_profile_file(const std::string& accuracy)
{
  const std::string extension = std::filesystem::path(accuracy).extension().string();
  return extension == ".yaml" || extension == ".yml";
}

// Reads a file with one profile, NAME: {...}, in the format of the scene's section `accuracy`.
AccuracyProfile read_profile_file(const std::string& path, double length_unit, const SceneNames& names)
{
  const YAML::Node yaml = load_yaml(path, "accuracy profile", "one profile, NAME: {voxel: ...}");
  ReadingContext context{ Faults(path), length_unit };
  const Node root(yaml, "", 1, context);
  AccuracyProfile profile;
  const auto profiles = root.named_pairs();
  if (profiles.size() == 1)
    profile = read_profile(profiles[0].first, profiles[0].second, names);
  else
    root.fault("found {} profiles; must be one, NAME: {{voxel: ...}}", profiles.size());
  if (!context.faults.empty())
    throw Error(context.faults.text());
  return profile;
}

auto find_profile(Scene& scene, const std::string& name)
{
  return std::find_if(scene.profiles.begin(), scene.profiles.end(),
                      [&](const AccuracyProfile& profile) { return profile.name == name; });
}

// Replaces the voxel edge of the chosen profile by the one in the options, if there is one.
void override_voxel(const Node& node, const SceneOptions& options, Scene& scene)
{
  double edge = options.voxel;
  if (!options.voxel_quantity.empty())
    try
    {
      edge = parse_quantity(options.voxel_quantity, Dimension::length, node.context().length_unit);
      if (!positive.holds(edge))
        throw Error("found '" + options.voxel_quantity + "'; must be " + positive.text());
    }
    catch (const Error& error)
    {
      node.fault("voxel edge asked for: " + std::string(error.what()));
      return;
    }
  if (!(edge > 0))
    return;
  scene.accuracy.voxel = { edge, edge, edge };
  // The measured error and cost hold for the original voxels only.
  scene.accuracy.measured = {};
  if (const auto profile = find_profile(scene, scene.accuracy.name); profile != scene.profiles.end())
    profile->measured = {};
}

}  // namespace

void read_accuracy(const Node& node, const SceneOptions& options, Scene& scene, const SceneNames& names)
{
  std::string chosen;
  std::optional<Node> chosen_by;
  std::vector<std::string> profiles;
  for (const auto& [name, entry] : node.named_pairs())
    if (name == "default")
    {
      chosen = entry.text();
      chosen_by.emplace(entry);
    }
    else
    {
      scene.profiles.push_back(read_profile(name, entry, names));
      profiles.push_back(name);
    }
  if (node.given() && !node.is_mapping())
    return;
  if (profiles.empty())
  {
    scene.profiles.emplace_back();
    scene.profiles[0].name = "standard";
    profiles = { "standard" };
  }

  if (is_profile_file(options.accuracy))
  {
    scene.accuracy = read_profile_file(options.accuracy, node.context().length_unit, names);
    // The profile from the file replaces a profile of the same name in the scene.
    if (const auto same = find_profile(scene, scene.accuracy.name); same != scene.profiles.end())
      scene.profiles.erase(same);
    scene.profiles.push_back(scene.accuracy);
    override_voxel(node, options, scene);
    return;
  }
  if (!options.accuracy.empty())
  {
    chosen = options.accuracy;
    chosen_by.reset();
  }
  else if (!chosen_by)
  {
    if (profiles.size() > 1)
      node.fault("'default' is missing; must name one of the profiles " + list_with_suggestion("", profiles));
    chosen = profiles[0];
  }
  if (chosen.empty())
    return;
  if (const auto found = find_profile(scene, chosen); found != scene.profiles.end())
    scene.accuracy = *found;
  else
    (chosen_by ? *chosen_by : node)
        .fault("no accuracy profile is called '{}'; the profiles are {}", chosen,
               list_with_suggestion(chosen, profiles));
  override_voxel(node, options, scene);
}

}  // namespace frontalis
