#pragma once

#include "frontalis/model/model.hpp"

#include <string>
#include <utility>

namespace frontalis
{

template <class Archive, class Mesh>
void exchange_mesh(Archive& archive, const std::string& path, Mesh& mesh)
{
  archive.array(path + "/vertices", mesh.vertices);
  archive.array(path + "/triangles", mesh.triangles);
}

template <class Archive, class Field>
void exchange_field(Archive& archive, const std::string& path, Field& field)
{
  archive.value(path + "/origin", field.origin);
  archive.value(path + "/spacing", field.spacing);
  archive.value(path + "/radius", field.radius);
  archive.value(path + "/bricks", field.bricks);
  archive.array(path + "/table", field.table);
  archive.array(path + "/samples", field.samples);
}

template <class Archive, class Bound>
void exchange_binding(Archive& archive, const std::string& path, Bound& binding)
{
  archive.array(path + "/voxel", binding.voxel);
  archive.array(path + "/coordinates", binding.coordinates);
}

/// The one description of our part of the file, for both directions. Derived arrays (nodes) are not in it.
template <class Archive, class AnyModel>
void exchange_model(Archive& archive, AnyModel& model, const std::string& root)
{
  const auto in = [&root](const std::string& name) { return root + "/" + name; };
  archive.value(in("spacing"), model.spacing);
  archive.value(in("size"), model.size);
  archive.array(in("voxels"), model.voxels);
  archive.array(in("fill"), model.fill);

  archive.group(in("materials"));
  archive.column(in("materials/name"), model.materials, &Material::name);
  archive.column(in("materials/law"), model.materials, &Material::law);
  archive.column(in("materials/parameters"), model.materials, &Material::parameters);
  archive.column(in("materials/density"), model.materials, &Material::density);
  archive.column(in("materials/viscous_share"), model.materials, &Material::viscous_share);
  archive.column(in("materials/viscous_time"), model.materials, &Material::viscous_time);
  archive.array(in("mixture_begin"), model.mixture_begin);
  archive.array(in("mixture_material"), model.mixture_material);
  archive.array(in("mixture_proportion"), model.mixture_proportion);
  archive.array(in("material_directions"), model.material_directions);

  archive.group(in("muscles"));
  archive.column(in("muscles/name"), model.muscles, &Muscle::name);
  archive.column(in("muscles/stress_reference"), model.muscles, &Muscle::stress_reference);
  archive.column(in("muscles/passive"), model.muscles, &Muscle::passive);
  archive.column(in("muscles/tension_length"), model.muscles, &Muscle::tension_length);
  archive.column(in("muscles/rise_time"), model.muscles, &Muscle::rise_time);
  archive.column(in("muscles/fall_time"), model.muscles, &Muscle::fall_time);
  archive.array(in("fibre_begin"), model.fibre_begin);
  archive.array(in("fibre_muscle"), model.fibre_muscle);
  archive.array(in("fibre_weight"), model.fibre_weight);
  archive.array(in("fibre_direction"), model.fibre_direction);

  archive.strings(in("bones"), model.bones);
  archive.strings(in("constraints"), model.constraints);
  archive.group(in("constraint_surfaces"));
  archive.column(in("constraint_surfaces/name"), model.constraint_surfaces, &ConstraintSurface::name);
  archive.column(in("constraint_surfaces/bone"), model.constraint_surfaces, &ConstraintSurface::bone);
  archive.column(in("constraint_surfaces/friction"), model.constraint_surfaces, &ConstraintSurface::friction);
  for (std::size_t s = 0; s < model.constraint_surfaces.size(); ++s)
  {
    const std::string path = in("constraint_surfaces/" + std::to_string(s));
    archive.group(path);
    exchange_field(archive, path, model.constraint_surfaces[s].field);
  }
  archive.group(in("rigid"));
  archive.column(in("rigid/node"), model.rigid, &RigidNode::node);
  archive.column(in("rigid/bone"), model.rigid, &RigidNode::bone);
  archive.column(in("rigid/constraint"), model.rigid, &RigidNode::constraint);
  archive.group(in("sliding"));
  archive.column(in("sliding/node"), model.sliding, &SlidingNode::node);
  archive.column(in("sliding/surface"), model.sliding, &SlidingNode::surface);
  archive.column(in("sliding/distance"), model.sliding, &SlidingNode::distance);
  archive.column(in("sliding/constraint"), model.sliding, &SlidingNode::constraint);

  archive.value(in("gravity"), model.gravity);
  archive.group(in("loads"));
  archive.column(in("loads/name"), model.loads, &Load::name);
  archive.column(in("loads/kind"), model.loads, &Load::kind);
  archive.column(in("loads/value"), model.loads, &Load::value);
  archive.column(in("loads/fixed"), model.loads, &Load::fixed);
  archive.column(in("loads/ramp"), model.loads, &Load::ramp);
  for (std::size_t l = 0; l < model.loads.size(); ++l)
  {
    const std::string path = in("loads/" + std::to_string(l));
    archive.group(path);
    exchange_mesh(archive, path, model.loads[l].mesh);
    exchange_binding(archive, path, model.loads[l].binding);
  }
  archive.group(in("prescribed"));
  archive.column(in("prescribed/node"), model.prescribed, &PrescribedNode::node);
  archive.column(in("prescribed/load"), model.prescribed, &PrescribedNode::load);

  archive.group(in("skin"));
  exchange_mesh(archive, in("skin"), model.skin);
  exchange_binding(archive, in("skin"), model.skin_binding);
  archive.group(in("landmarks"));
  archive.strings(in("landmarks/name"), model.landmarks);
  archive.array(in("landmarks/position"), model.landmark_positions);
  exchange_binding(archive, in("landmarks"), model.landmark_binding);

  archive.group(in("frames"));
  archive.value(in("frames/to_scene_rotation"), model.to_scene.rotation);
  archive.value(in("frames/to_scene_translation"), model.to_scene.translation);
  archive.value(in("frames/to_face_rotation"), model.to_face.rotation);
  archive.value(in("frames/to_face_translation"), model.to_face.translation);
  archive.value(in("frames/face_frame"), model.face_frame);

  archive.group(in("time"));
  archive.value(in("time/damping"), model.damping);
  archive.value(in("time/scaling"), model.time_scaling);
  archive.value(in("time/frame_rate"), model.frame_rate);
  archive.value(in("time/activation_slew"), model.activation_slew);
  archive.value(in("time/step_share"), model.time_step_share);
  archive.value(in("time/step_estimate"), model.time_step_estimate);
  archive.value(in("hourglass"), model.hourglass);
  archive.value(in("integration"), model.integration);
  archive.value(in("precision"), model.precision);
  archive.group(in("mass_scaling"));
  archive.value(in("mass_scaling/kind"), model.mass_scaling.kind);
  archive.value(in("mass_scaling/factor"), model.mass_scaling.factor);
  archive.value(in("mass_scaling/time_step"), model.mass_scaling.time_step);
  archive.array(in("mass_scaling/materials"), model.mass_scaling.materials);

  archive.group(in("expressions"));
  archive.column(in("expressions/name"), model.expressions, &Model::Expression::name);
  using Activation = std::pair<std::int32_t, float>;
  for (std::size_t e = 0; e < model.expressions.size(); ++e)
  {
    const std::string path = in("expressions/" + std::to_string(e));
    archive.group(path);
    archive.column(path + "/muscle", model.expressions[e].activation, &Activation::first);
    archive.column(path + "/activation", model.expressions[e].activation, &Activation::second);
  }
  archive.group(in("demo"));
  archive.column(in("demo/expression"), model.demo, &Model::DemoPhase::expression);
  archive.column(in("demo/ramp"), model.demo, &Model::DemoPhase::ramp);
  archive.column(in("demo/seconds"), model.demo, &Model::DemoPhase::seconds);
  archive.strings(in("switched_off"), model.switched_off);
  using Profile = Model::AccuracyProfile;
  archive.group(in("profiles"));
  archive.column(in("profiles/name"), model.profiles, &Profile::name);
  archive.column(in("profiles/error"), model.profiles, &Profile::error);
  archive.column(in("profiles/cost"), model.profiles, &Profile::cost);
  archive.column(in("profiles/machine"), model.profiles, &Profile::machine);
  archive.value(in("profile"), model.profile);
  archive.value(in("scene_hash"), model.scene_hash);
}

}  // namespace frontalis
