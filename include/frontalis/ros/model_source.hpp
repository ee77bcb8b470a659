#pragma once

#include "frontalis/model/model.hpp"

#include <atomic>
#include <functional>
#include <string>

namespace frontalis
{

/// What to bake, and by which program.
struct BakeRequest
{
  std::string program;         ///< path of the program `frontalis`
  std::string scene;           ///< scene file
  std::string mesh_directory;  ///< empty: as the scene says
  std::string accuracy;        ///< profile; empty: the scene's default
  std::string cache;           ///< folder that keeps models by their scenes' content; empty: none is kept
};

/// Called with each line that the program prints.
using BakeLog = std::function<void(const std::string& line)>;

/// The program `frontalis`: `wanted` where it is not empty, else the first executable file of that name in the folder
/// of the running executable, in the folder `frontalis` beside this library, and on PATH. Throws Error with the places
/// that were tried.
std::string find_program(const std::string& wanted);

/// The folder `frontalis` in ROS_HOME, which is ~/.ros where it is not set; empty where there is neither.
std::string default_cache();

/// Bakes a scene by running the program in a process of its own, into a temporary folder that is removed again, and
/// reads the model. A crash there does not reach the caller. The process is ended early once `cancelled` becomes true.
/// Throws Error with what the program wrote to standard error, or how it ended.
Model bake_in_process(const BakeRequest& request, const BakeLog& log, const std::atomic<bool>& cancelled);

}  // namespace frontalis
