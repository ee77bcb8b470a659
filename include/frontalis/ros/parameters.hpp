#pragma once

#include "frontalis/ros/model_source.hpp"
#include "frontalis/runner/runner.hpp"

#include <ros/node_handle.h>

#include <string>

namespace frontalis
{

/// The private parameters of the node (doc/ros.md), checked.
struct FaceParameters
{
  std::string model;      ///< baked model file; empty: a scene is baked
  BakeRequest bake;       ///< ~scene, ~mesh_dir, ~accuracy, ~cache, ~program (as find_program takes it)
  RunnerSettings runner;  ///< ~backend, ~threads, ~pace, ~frame_rate, ~guard_interval
  SkinField skin_field = SkinField::strain;  ///< the field that ~skin_field publishes
  std::string face_id;                       ///< the face frame is face_<id>; empty: the model's
  std::string parent_frame = "map";          ///< parent of the face frame; empty: no static transform
  bool demo = false;                         ///< whether to play the model's demo
  double real_time_factor_warning = 0.5;     ///< diagnostics warn below this, at pace real_time
};

/// Reads the parameters. Throws an Error that names every bad parameter, the value found and the allowed values.
FaceParameters read_parameters(const ros::NodeHandle& private_handle);

}  // namespace frontalis
