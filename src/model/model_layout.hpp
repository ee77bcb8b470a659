#pragma once

#include "model/model_archive.hpp"

#include "frontalis/model/model.hpp"
#include "model/effect_description.hpp"

#include <string>
#include <utility>

namespace frontalis
{

template <class Archive, class Mesh>
void exchange_mesh(Archive& archive, const std::string& path, Mesh& mesh)
{
  archive(path + "/vertices", mesh.vertices);
  archive(path + "/triangles", mesh.triangles);
}

template <class Archive, class Field>
void exchange_field(Archive& archive, const std::string& path, Field& field)
{
  archive(path + "/origin", field.origin);
  archive(path + "/spacing", field.spacing);
  archive(path + "/radius", field.radius);
  archive(path + "/bricks", field.bricks);
  archive(path + "/table", field.table);
  archive(path + "/samples", field.samples);
}

template <class Archive, class Bound>
void exchange_binding(Archive& archive, const std::string& path, Bound& binding)
{
  archive(path + "/voxel", binding.voxel);
  archive(path + "/coordinates", binding.coordinates);
}

template <class Archive, class Bones>
void exchange_bones(Archive& archive, const std::string& path, Bones& bones)
{
  using Pose = Model::BonePose;
  if (archive.group_if(!bones.empty(), path))
    archive.table(path, bones, Column{ "bone", &Pose::bone }, Column{ "shift", &Pose::shift },
                  Column{ "turn", &Pose::turn }, Column{ "centre", &Pose::centre });
}

template <class Archive, class Poses>
void exchange_poses(Archive& archive, const std::string& path, Poses& poses)
{
  archive.table(path, poses, Column{ "name", &Model::Expression::name });
  using Activation = std::pair<std::int32_t, float>;
  for (std::size_t p = 0; p < poses.size(); ++p)
  {
    const std::string group = path + "/" + std::to_string(p);
    archive.table(group, poses[p].activation, Column{ "muscle", &Activation::first },
                  Column{ "activation", &Activation::second });
    exchange_bones(archive, group + "/bones", poses[p].bones);
  }
}

/// Writes the group VTKHDF, version 1.0, with which ParaView opens the model file: an unstructured grid of VTK_VOXEL
/// cells, whose corners have the same order as those of our voxels. It has material, fill, muscle and fibre of each
/// voxel and the constraint of each node. Points are in local coordinates [m].
void write_vtk_arrays(Hdf5File& file, const Model& model);

/// Lists all arrays that a model file stores, once for writing and reading. Nodes are derived and therefore not stored.
template <class Archive, class AnyModel>
void exchange_model(Archive& archive, AnyModel& model)
{
  archive("spacing", model.spacing);
  archive("size", model.size);
  archive("voxels", model.voxels);
  archive("fill", model.fill);
  if (archive.group_if(!model.flaps.empty(), "flaps"))
  {
    archive.table("flaps", model.flaps, Column{ "first", &Model::Flap::first }, Column{ "shift", &Model::Flap::shift });
    archive.table("joints", model.joints, Column{ "node", &Model::Joint::node },
                  Column{ "master", &Model::Joint::master });
  }

  archive.table("materials", model.materials, Column{ "name", &Material::name }, Column{ "law", &Material::law },
                Column{ "parameters", &Material::parameters }, Column{ "density", &Material::density },
                Column{ "viscous_share", &Material::viscous_share }, Column{ "viscous_time", &Material::viscous_time });
  archive("mixture_begin", model.mixture_begin);
  archive("mixture_material", model.mixture_material);
  archive("mixture_proportion", model.mixture_proportion);
  archive("material_directions", model.material_directions);

  archive.table("muscles", model.muscles, Column{ "name", &Muscle::name },
                Column{ "stress_reference", &Muscle::stress_reference }, Column{ "passive", &Muscle::passive },
                Column{ "tension_length", &Muscle::tension_length }, Column{ "rise_time", &Muscle::rise_time },
                Column{ "fall_time", &Muscle::fall_time }, Column{ "tone", &Muscle::tone });
  archive("fibre_begin", model.fibre_begin);
  archive("fibre_muscle", model.fibre_muscle);
  archive("fibre_weight", model.fibre_weight);
  archive("fibre_direction", model.fibre_direction);

  archive("bones", model.bones);
  archive("constraints", model.constraints);
  archive.table("constraint_surfaces", model.constraint_surfaces, Column{ "name", &ConstraintSurface::name },
                Column{ "bone", &ConstraintSurface::bone }, Column{ "friction", &ConstraintSurface::friction });
  for (std::size_t s = 0; s < model.constraint_surfaces.size(); ++s)
    exchange_field(archive, "constraint_surfaces/" + std::to_string(s), model.constraint_surfaces[s].field);
  archive.table("rigid", model.rigid, Column{ "node", &RigidNode::node }, Column{ "bone", &RigidNode::bone },
                Column{ "constraint", &RigidNode::constraint });
  archive.table("sliding", model.sliding, Column{ "node", &SlidingNode::node },
                Column{ "surface", &SlidingNode::surface }, Column{ "distance", &SlidingNode::distance },
                Column{ "constraint", &SlidingNode::constraint });

  exchange_effects(archive, model);

  archive("gravity", model.gravity);
  archive.table("loads", model.loads, Column{ "name", &Load::name }, Column{ "kind", &Load::kind },
                Column{ "value", &Load::value }, Column{ "fixed", &Load::fixed }, Column{ "ramp", &Load::ramp },
                Column{ "activation", &Load::activation });
  for (std::size_t l = 0; l < model.loads.size(); ++l)
  {
    const std::string path = "loads/" + std::to_string(l);
    exchange_mesh(archive, path, model.loads[l].mesh);
    exchange_binding(archive, path, model.loads[l].binding);
  }
  archive.table("prescribed", model.prescribed, Column{ "node", &PrescribedNode::node },
                Column{ "load", &PrescribedNode::load });

  exchange_mesh(archive, "skin", model.skin);
  exchange_binding(archive, "skin", model.skin_binding);
  if (archive.group_if(!model.film.laws.empty(), "film"))
  {
    archive.table("film", model.film.laws, Column{ "thickness", &FilmLaw::thickness },
                  Column{ "modulus", &FilmLaw::modulus }, Column{ "poisson", &FilmLaw::poisson },
                  Column{ "base_modulus", &FilmLaw::base_modulus }, Column{ "stretch", &FilmLaw::stretch });
    archive("film/law", model.film.law);
    archive("film/carried", model.film.carried);
    archive("film/parents", model.film.parents);
    if (archive.group_if(!model.film.crease.empty(), "film/crease"))
      archive("film/crease", model.film.crease);
  }
  archive("landmarks/name", model.landmarks);
  archive("landmarks/position", model.landmark_positions);
  exchange_binding(archive, "landmarks", model.landmark_binding);

  archive("frames/to_scene_rotation", model.to_scene.rotation);
  archive("frames/to_scene_translation", model.to_scene.translation);
  archive("frames/to_face_rotation", model.to_face.rotation);
  archive("frames/to_face_translation", model.to_face.translation);
  archive("frames/face_frame", model.face_frame);

  archive("time/damping", model.damping);
  archive("time/scaling", model.time_scaling);
  archive("time/frame_rate", model.frame_rate);
  archive("time/activation_slew", model.activation_slew);
  archive("time/step_share", model.time_step_share);
  archive("time/step_estimate", model.time_step_estimate);
  archive("hourglass", model.hourglass);
  archive("integration", model.integration);
  archive("precision", model.precision);
  archive("mass_scaling/kind", model.mass_scaling.kind);
  archive("mass_scaling/factor", model.mass_scaling.factor);
  archive("mass_scaling/time_step", model.mass_scaling.time_step);
  archive("mass_scaling/in_motion", model.mass_scaling.in_motion);
  archive("mass_scaling/materials", model.mass_scaling.materials);

  exchange_poses(archive, "expressions", model.expressions);
  exchange_poses(archive, "action_units", model.action_units);
  using Phase = Model::DemoPhase;
  archive.table("demo", model.demo, Column{ "expression", &Phase::expression }, Column{ "ramp", &Phase::ramp },
                Column{ "seconds", &Phase::seconds });
  for (std::size_t p = 0; p < model.demo.size(); ++p)
    exchange_bones(archive, "demo/" + std::to_string(p), model.demo[p].bones);
  archive("switched_off", model.switched_off);
  using Profile = Model::AccuracyProfile;
  archive.table("profiles", model.profiles, Column{ "name", &Profile::name }, Column{ "error", &Profile::error },
                Column{ "cost", &Profile::cost }, Column{ "machine", &Profile::machine });
  archive("profile", model.profile);
  archive("scene_hash", model.scene_hash);
}

}  // namespace frontalis
