#include "bake/shapes/head/head.hpp"
#include "bake/messages.hpp"
#include "frontalis/physics/materials/lookup.hpp"
#include "frontalis/content_hash.hpp"
#include "bake/voxels/model_stages.hpp"

namespace frontalis
{
namespace
{

Material material_of(const Scene& scene, const SceneMaterial& material, const LocalFrame& frame)
{
  const std::string place = fmt::format("{}:{}: material '{}'", scene.file, material.line, material.name);
  const auto parameter = [&](const std::string& name)
  {
    const auto found = material.parameters.find(name);
    if (found == material.parameters.end())
      throw failure("{}: has no '{}'", place, name);
    return found->second;
  };
  const auto law = physics::law_named(material.law);
  if (!law)
    throw failure("{}: law '{}' is not known", place, material.law);
  const physics::MaterialDescription& description = physics::description_of(*law);
  std::array<double, physics::law_parameters_max> given{};
  for (int p = 0; p < description.count(); ++p)
    if (!description.parameters[p].optional || material.parameters.count(description.parameters[p].key) > 0)
      given[p] = parameter(description.parameters[p].key);
  const double poisson = parameter("poisson");
  Material out;
  out.name = material.name;
  out.law = *law;
  out.density = material.density;
  out.parameters = physics::numbers_of(*law, given, poisson);
  const double shear = physics::shear_modulus_of(*law, out.parameters);
  if (scene.accuracy.bulk_modulus_max > 0)
  {
    double& bulk = out.parameters[physics::bulk_modulus_slot];
    bulk = physics::limited_bulk_modulus(bulk, shear, scene.accuracy.bulk_modulus_max);
  }
  for (int d = 0; d < description.directions; ++d)
  {
    const Vector3 direction = frame.turn(material.families[d]);
    std::copy(direction.begin(), direction.end(), out.parameters.begin() + physics::first_direction + 3 * d);
  }
  for (std::size_t term = 0; term < material.viscosity.size() && term < out.viscous_share.size(); ++term)
  {
    out.viscous_share[term] = material.viscosity[term].share;
    out.viscous_time[term] = material.viscosity[term].time;
  }
  if (!(shear > 0) || !(poisson > -1) || !(poisson < 0.5))
    throw failure(
        "{}: its shear modulus at rest is {} Pa and its Poisson's ratio {}; the modulus must be above 0 and the ratio "
        "between -1 and 0.5",
        place, shear, poisson);
  if (!(material.density > 0))
    throw failure("{}: density is {} kg/m3; it must be above 0", place, material.density);
  return out;
}

/// Axes of the face frame (forward, left, up) as unit vectors in scene axes.
std::array<Vector3d, 3> face_axes(const Scene& scene)
{
  const Vector3d forward = to_vector(scene.frame.forward).normalized(), upwards = to_vector(scene.frame.up);
  const Vector3d up = (upwards - upwards.dot(forward) * forward).normalized();
  if (forward.norm() < 0.5 || up.norm() < 0.5)
    throw Error(scene.file + ": frame: 'forward' and 'up' must have a length and must not be parallel");
  return { forward, up.cross(forward), up };
}

Vector3 in_face_frame(const Scene& scene, const Vector3& position)
{
  const auto axes = face_axes(scene);
  const Vector3d from_origin = to_vector(position) - to_vector(scene.frame.origin);
  return { axes[0].dot(from_origin), axes[1].dot(from_origin), axes[2].dot(from_origin) };
}

void copy_presets(const Scene& scene, Model& model)
{
  for (const auto& [from, to] :
       { std::pair{ &scene.expressions, &model.expressions }, std::pair{ &scene.action_units, &model.action_units } })
    for (const auto& [name, pose] : *from)
    {
      Model::Expression& copy = to->emplace_back(Model::Expression{ name, {} });
      for (const auto& [muscle, activation] : pose.activation)
        copy.activation.emplace_back(
            index_of(model.muscles, muscle, scene.file + ": expression '" + name + "'", "muscle"),
            static_cast<float>(activation));
    }
  for (const DemoPhase& phase : scene.demo)
    model.demo.push_back({ phase.expression.empty() ? -2
                           : phase.expression == "relax"
                               ? -1
                               : index_of(model.expressions, phase.expression, scene.file + ": demo", "expression"),
                           phase.ramp, phase.seconds });
}

void copy_mass_scaling(const Scene& scene, Model& model)
{
  const MassScaling& from = scene.accuracy.mass_scaling;
  // both enumerations have the values none, uniform, selective
  model.mass_scaling = {
    static_cast<MassScalingSettings::Kind>(from.kind), from.factor, {}, from.time_step, from.in_motion
  };
  for (const std::string& name : from.materials)
    model.mass_scaling.materials.push_back(index_of(model.materials, name, scene.file + ": mass_scaling", "material"));
}

}  // namespace

void copy_settings(const Scene& scene, const LocalFrame& frame, Model& model)
{
  const auto axes = face_axes(scene);
  model.to_scene.rotation.fill(0);
  for (std::size_t local = 0; local < 3; ++local)
    model.to_scene.rotation[3 * frame.scene_axis(local) + local] = 1;
  model.to_scene.translation = to_array(frame.origin);
  for (std::size_t row = 0; row < 3; ++row)
  {
    const Vector3d turned = frame.turn(axes[row]);
    for (std::size_t column = 0; column < 3; ++column)
      model.to_face.rotation[3 * row + column] = turned[column];
    model.to_face.translation[row] = axes[row].dot(frame.origin - to_vector(scene.frame.origin));
  }
  model.face_frame = scene.frame.id;
  model.gravity = frame.turn(scene.gravity);

  for (const SceneMuscle& muscle : scene.muscles)
    model.muscles.push_back({ muscle.name, muscle.stress_reference, muscle.passive, muscle.tension_length,
                              muscle.rise_time / scene.time.scaling, muscle.fall_time / scene.time.scaling,
                              muscle.tone });
  for (const SceneLoad& load : scene.loads)
    if (load.activated)
      model.muscles.emplace_back().name = load.name;
  model.damping = scene.time.damping;
  model.time_scaling = scene.time.scaling;
  model.frame_rate = scene.time.frame_rate;
  model.activation_slew = scene.time.activation_slew * scene.time.scaling;
  model.time_step_share = scene.accuracy.time_step_share;
  for (const SceneMaterial& material : scene.materials)
    model.materials.push_back(material_of(scene, material, frame));
  if (scene.accuracy.assumed_strain)
    model.hourglass = HourglassControl::assumed_strain;
  if (scene.accuracy.integration == "selective_reduced")
    model.integration = Integration::selective_reduced;
  if (scene.accuracy.precision == "compensated")
    model.precision = Precision::compensated;
  else if (scene.accuracy.precision == "double")
    model.precision = Precision::double_precision;
  if (scene.accuracy.time_step == "assembled")
    model.time_step_estimate = TimeStepEstimate::assembled;
  copy_mass_scaling(scene, model);
  copy_presets(scene, model);
  for (const AccuracyProfile& profile : scene.profiles)
    model.profiles.push_back({ profile.name, profile.measured.error, profile.measured.cost, profile.measured.machine });
  model.profile = scene.accuracy.name;
  model.scene_hash = scene.content.empty() ? "" : content_hash(scene.content);
}

/// The pose of a bone in the face frame: its shift and turn, plus those of its joint at the pose's angle.
static Model::BonePose pose_of(const Scene& scene, const BonePose& pose, std::int32_t bone)
{
  const auto has_bone = [&](const SceneJoint& joint) { return joint.bone == pose.bone; };
  const auto of_bone = std::find_if(scene.joints.begin(), scene.joints.end(), has_bone);
  if (pose.angle == 0 || of_bone == scene.joints.end())
  {
    const auto centre = scene.bone_centres.find(pose.bone);
    return { bone, pose.shift, pose.turn,
             centre == scene.bone_centres.end() ? Vector3{} : in_face_frame(scene, centre->second) };
  }
  Eigen::Matrix3d to_face;
  const auto axes = face_axes(scene);
  for (Eigen::Index row = 0; row < 3; ++row)
    to_face.row(row) = axes[static_cast<std::size_t>(row)];
  const Vector3d at = to_vector(of_bone->joint.at);
  const Vector3d shift = to_vector(pose.shift) + pose.angle * (to_face * to_vector(of_bone->joint.slide));
  const Vector3d turn = to_vector(pose.turn) + pose.angle * (to_face * to_vector(of_bone->joint.axis));
  return { bone, to_array(shift), to_array(turn),
           in_face_frame(scene, to_array(of_bone->head ? head_of(*of_bone->head)->moved(at) : at)) };
}

void copy_poses(const Scene& scene, Model& model)
{
  const auto copy = [&](const std::vector<BonePose>& from, std::vector<Model::BonePose>& to)
  {
    for (const BonePose& pose : from)
      if (const auto bone = std::find(model.bones.begin(), model.bones.end(), pose.bone); bone != model.bones.end())
        to.push_back(pose_of(scene, pose, static_cast<std::int32_t>(bone - model.bones.begin())));
  };
  std::size_t p = 0;
  for (const auto& [name, pose] : scene.expressions)
    copy(pose.bones, model.expressions[p++].bones);
  p = 0;
  for (const auto& [name, pose] : scene.action_units)
    copy(pose.bones, model.action_units[p++].bones);
  for (p = 0; p < scene.demo.size(); ++p)
    copy(scene.demo[p].bones, model.demo[p].bones);
}

}  // namespace frontalis
