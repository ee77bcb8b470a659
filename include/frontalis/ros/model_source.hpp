#pragma once

#include "frontalis/model/model.hpp"

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace frontalis
{

/// The scene to bake, and the program that bakes it.
struct BakeRequest
{
  std::string program;         ///< path of the program `frontalis`
  std::string scene;           ///< path of the scene file
  std::string mesh_directory;  ///< folder of the mesh files; empty: the folder that the scene names
  std::string accuracy;        ///< accuracy profile; empty: the scene's default profile
  std::string cache;           ///< folder that keeps baked models by the content of their scenes; empty: no cache
};

/// Called with each line that the program prints.
using BakeLog = std::function<void(const std::string& line)>;

/// Adds the options of the program that say how a scene is baked.
void add_scene_arguments(const BakeRequest& request, std::vector<std::string>& arguments);

/// Makes a folder in the system's temporary folder, which is removed with its contents by the last owner of the path.
std::shared_ptr<const std::filesystem::path> temporary_folder();

/// Runs a program to its end. The program is killed within 0.1 s after `cancelled` becomes true, and when the calling
/// thread or process ends. If it fails, throws an Error with its output to standard error, or the way it ended.
void run_program(const std::string& program, const std::vector<std::string>& arguments, const BakeLog& log,
                 const std::atomic<bool>& cancelled);

/// The path of the program `frontalis`: `wanted` if it is not empty, else the first executable file of that name in the
/// folder of the running executable, in the folder `frontalis` beside this library, and in the folders of PATH. Throws
/// an Error that lists the places where it looked.
std::string find_program(const std::string& wanted);

/// The default cache: the folder `frontalis` in ROS_HOME, or in ~/.ros if ROS_HOME is not set; empty if HOME is not set
/// either.
std::string default_cache();

/// Bakes a scene in a separate process, so that a crash of the bake does not reach the caller, and reads the model. The
/// process writes into a temporary folder. Is cancelled and throws as run_program().
Model bake_in_process(const BakeRequest& request, const BakeLog& log, const std::atomic<bool>& cancelled);

}  // namespace frontalis
