#pragma once

#include "frontalis/ros/model_source.hpp"
#include "frontalis/runner/runner.hpp"

#include <ros/node_handle.h>

#include <string>
#include <vector>

namespace frontalis
{

/// The frame that a bone follows: the bone's motion takes the frame `rest` to the frame `frame`.
struct BoneFrame
{
  std::string bone, frame;
  std::string rest;  ///< frame where `frame` is while the bone is at rest; empty: the face frame
};

/// Parameters of the messages that move the face.
struct InputParameters
{
  double command_timeout = 0;          ///< silence after which the face relaxes [simulated s]; 0: never
  double relax_time = 0.5;             ///< duration of the relaxation after this silence [simulated s]
  double stamp_tolerance = 1;          ///< greatest age of messages and transforms, in either direction [s]
  std::string blendshapes;             ///< file of the table of blendshapes; empty: none
  std::vector<BoneFrame> bone_frames;  ///< frames that bones follow
  double bone_speed = 0.5;             ///< greatest speed of these bones [m/s]
  bool demo = false;                   ///< whether to play the model's demo
};

/// The quantity that the colours of ~skin and ~skin_points show.
enum class SkinColour
{
  skin,
  displacement,  ///< distance from rest [m]
  activation,    ///< that of the muscles below the skin (SkinMuscles)
  field          ///< FaceParameters::skin_field
};

SkinColour skin_colour_from_name(const std::string& name);  ///< throws Error if the name is unknown

/// The private parameters of the node (doc/ros.md), checked.
struct FaceParameters
{
  std::string model;      ///< baked model file; empty: a scene is baked
  BakeRequest bake;       ///< ~scene, ~mesh_dir, ~accuracy, ~cache, ~program (as in find_program())
  RunnerSettings runner;  ///< ~backend, ~threads, ~pace, ~frame_rate, ~guard_interval
  InputParameters inputs;
  SkinField skin_field = SkinField::strain;  ///< the field that ~skin_field publishes
  SkinColour skin_colour = SkinColour::skin;
  double colour_range = 0;                ///< value with the last colour; 0: the default of skin_colour
  std::vector<double> wrinkles_in;        ///< LEFT, UP, LEFT, UP [m]: part of the skin of ~wrinkles; empty: all
  std::string face_id;                    ///< the face frame is face_<id>; empty: the model's frame
  std::string parent_frame = "map";       ///< parent of the face frame; empty: no static transform
  double real_time_factor_warning = 0.5;  ///< diagnostics warn below this factor, at pace real_time
};

/// Reads the parameters. Throws an Error that names every bad parameter, the value found and the allowed values.
/// `names_face`: whether one of ~scene and ~model must be given.
FaceParameters read_parameters(const ros::NodeHandle& private_handle, bool names_face = true);

}  // namespace frontalis
