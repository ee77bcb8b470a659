#include "frontalis/ros/parameters.hpp"

#include "frontalis/error.hpp"
#include "ros/parameter_reader.hpp"

#include <fmt/format.h>
#include <ros/package.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <sstream>

namespace frontalis
{

namespace
{

Pace pace_from_name(const std::string& name)
{
  for (const auto& [known, pace] :
       { std::pair{ "real_time", Pace::real_time }, { "fastest", Pace::fastest }, { "lock_step", Pace::lock_step } })
    if (name == known)
      return pace;
  throw Error(fmt::format("found '{}'; allowed are real_time, fastest and lock_step", name));
}

/// Reads the parameter ~bone_frames: for each bone a frame, or a mapping {frame, rest} with the frame's place at rest.
std::vector<BoneFrame> read_bone_frames(ParameterReader& reader)
{
  std::vector<BoneFrame> out;
  constexpr const char* allowed = "a mapping of bones to frames";
  auto all = reader.value("bone_frames", XmlRpc::XmlRpcValue(), allowed);
  if (!all.valid())
    return out;
  if (all.getType() != XmlRpc::XmlRpcValue::TypeStruct)
  {
    reader.add_fault("bone_frames", std::string("has the wrong type; allowed is ") + allowed);
    return out;
  }
  for (auto& [bone, value] : all)
  {
    const auto text = [&entry = value](const char* key) -> std::string
    { return entry.hasMember(key) && entry[key].getType() == XmlRpc::XmlRpcValue::TypeString ? entry[key] : ""; };
    BoneFrame followed{ bone, {}, {} };
    if (value.getType() == XmlRpc::XmlRpcValue::TypeString)
      followed.frame = static_cast<std::string>(value);
    else if (value.getType() == XmlRpc::XmlRpcValue::TypeStruct)
      followed = { bone, text("frame"), text("rest") };
    const int known = (followed.frame.empty() ? 0 : 1) + (followed.rest.empty() ? 0 : 1);
    const bool unknown = value.getType() == XmlRpc::XmlRpcValue::TypeStruct && value.size() > known;
    if (followed.frame.empty() || unknown)
      reader.add_fault("bone_frames/" + bone, "allowed is the name of a frame, or a mapping with frame and rest");
    out.push_back(followed);
  }
  return out;
}

/// Reads the parameter ~effects_off, which FaceNode::apply_config() applies.
void check_effects_off(ParameterReader& reader)
{
  std::istringstream words(reader.text("effects_off", ""));
  try
  {
    for (std::string word; words >> word;)
      effect_from_name(word);
  }
  catch (const Error& error)
  {
    reader.add_fault("effects_off", error.what());
  }
}

}  // namespace

SkinColour skin_colour_from_name(const std::string& name)
{
  for (const auto& [known, colour] : { std::pair{ "skin", SkinColour::skin },
                                       { "displacement", SkinColour::displacement },
                                       { "activation", SkinColour::activation },
                                       { "field", SkinColour::field } })
    if (name == known)
      return colour;
  throw Error(fmt::format("found '{}'; allowed are skin, displacement, activation and field", name));
}

FaceParameters read_parameters(const ros::NodeHandle& private_handle, bool names_face)
{
  ParameterReader reader(private_handle);
  FaceParameters out;
  constexpr const char* four_numbers =
      "[LEFT, UP, LEFT, UP]: numbers [m], the first corner to the right of the second and below it";
  out.bake.scene = reader.text("scene", "");
  out.model = reader.text("model", "");
  if (names_face && out.bake.scene.empty() == out.model.empty())
    reader.add_fault("scene", fmt::format("found {}; allowed is either ~scene (a scene file) or ~model (a baked model)",
                                          out.model.empty() ? "neither ~scene nor ~model" : "both"));
  out.bake.mesh_directory = reader.text("mesh_dir", "");
  out.bake.accuracy = reader.text("accuracy", "");
  out.bake.cache = reader.text("cache", default_cache());
  out.bake.program = reader.text("program", "");

  out.runner.solver.backend = reader.named("backend", "auto", &backend_from_name);
  out.runner.solver.threads =
      reader.number("threads", 0, "a whole number; 0: one per core", 0, "0 (one per core) or more");
  out.runner.pace = reader.named("pace", "real_time", &pace_from_name);
  out.runner.frame_rate =
      reader.number("frame_rate", 0.0, "a number [1/s]; 0: the model's", 0.0, "0 (the model's) or 0.1 to 1000 [1/s]");
  if (const double rate = out.runner.frame_rate; rate > 0 && (rate < slowest_frame_rate || rate > fastest_frame_rate))
    reader.add_fault("frame_rate", fmt::format("found {}; allowed are 0 (the model's) or {} to {} [1/s]", rate,
                                               slowest_frame_rate, fastest_frame_rate));
  const int interval = reader.number("guard_interval", -1, "a whole number of time steps; 0: no guard", -1,
                                     "0 (no guard) or more, or -1 (the backend's choice)");
  if (interval == 0)
    out.runner.guard.reset();
  else
    out.runner.guard->interval = std::max(interval, 0);
  out.skin_field = reader.named("skin_field", "strain", &skin_field_from_name);
  out.skin_colour = reader.named("skin_colour", "skin", &skin_colour_from_name);
  out.colour_range = reader.number("colour_range", 0.0, "a number", 0.0, "0 (that of the field) or more");
  const auto& part = out.wrinkles_in = reader.value("wrinkles_in", std::vector<double>(), four_numbers);
  if (!part.empty() && !(part.size() == 4 && part[0] < part[2] && part[1] < part[3]))
    reader.add_fault("wrinkles_in", fmt::format("found {}; allowed is {}", fmt::join(part, ", "), four_numbers));
  out.face_id = reader.text("face_id", "");
  const auto in_names = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
  if (!std::all_of(out.face_id.begin(), out.face_id.end(), in_names))
    reader.add_fault("face_id", fmt::format("found '{}'; allowed are letters, digits and '_'", out.face_id));
  out.parent_frame = reader.text("parent_frame", "map");
  out.inputs.demo = reader.value("demo", false, "true or false");
  const auto seconds = [&](const char* key, double fallback)
  { return reader.number(key, fallback, "a number [s]", 0.0, "0 or more [s]"); };
  out.inputs.command_timeout = seconds("command_timeout", out.inputs.command_timeout);
  out.inputs.relax_time = seconds("relax_time", out.inputs.relax_time);
  out.inputs.stamp_tolerance = seconds("stamp_tolerance", out.inputs.stamp_tolerance);
  out.inputs.blendshapes =
      reader.text("blendshapes_table", ros::package::getPath("frontalis") + "/config/blendshapes.yaml");
  out.inputs.bone_frames = read_bone_frames(reader);
  out.inputs.bone_speed = reader.number("bone_speed", out.inputs.bone_speed, "a number [m/s]", 0.0, "0 or more [m/s]");
  reader.number("damping", -1.0, "a number [1/s]; below 0: the model's", std::numeric_limits<double>::lowest(),
                "a finite number [1/s]; below 0: the model's");
  check_effects_off(reader);
  out.real_time_factor_warning = reader.number("real_time_factor_warning", 0.5, "a number", 0.0, "0 or more");
  reader.finish();
  return out;
}

}  // namespace frontalis
