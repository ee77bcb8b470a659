#pragma once

#include "frontalis/runner/runner.hpp"

#include <ros/node_handle.h>

#include <string>

namespace frontalis
{

/// Private parameters of the node (doc/ros.md), checked.
struct FaceParameters
{
  std::string scene;                         ///< scene file to bake; exactly one of scene and model is given
  std::string model;                         ///< baked model file
  std::string mesh_directory;                ///< ~mesh_dir; empty: as the scene says
  std::string accuracy;                      ///< profile of the scene; empty: the scene's default
  std::string cache;                         ///< folder of models baked before; empty: none is kept
  std::string program;                       ///< the program `frontalis`; empty: looked for (see find_program)
  RunnerSettings runner;                     ///< ~backend, ~threads, ~pace, ~frame_rate, ~guard_interval
  SkinField skin_field = SkinField::strain;  ///< that ~skin_field shows
  std::string face_id;                       ///< frame is face_<id>; empty: the model's frame
  std::string parent_frame = "map";          ///< of the static transform to the face; empty: none is published
  bool demo = false;                         ///< play the model's demo
  double real_time_factor_warning = 0.5;     ///< below this the diagnostics warn; pace real_time only
};

/// Reads the parameters of the private handle. Throws Error that names every bad one, what was found and what is
/// allowed.
FaceParameters read_parameters(const ros::NodeHandle& private_handle);

}  // namespace frontalis
