#include "frontalis/ros/parameters.hpp"

#include "frontalis/error.hpp"
#include "frontalis/ros/model_source.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace frontalis
{

namespace
{

/// Reads parameters one by one and gathers what is wrong with them.
class Reader
{
public:
  explicit Reader(const ros::NodeHandle& handle) : handle_(handle) {}

  std::string text(const std::string& key, const std::string& fallback)
  {
    std::string value;
    int number = 0;
    if (!handle_.hasParam(key) || handle_.getParam(key, value))
      return handle_.hasParam(key) ? value : fallback;
    // roslaunch turns a value such as 1 into a number
    if (handle_.getParam(key, number))
      return std::to_string(number);
    fault(key, "a text");
    return fallback;
  }

  template <typename T>
  T value(const std::string& key, T fallback, const char* allowed)
  {
    T found = fallback;
    if (handle_.hasParam(key) && !handle_.getParam(key, found))
      fault(key, allowed);
    return found;
  }

  void check(bool good, const std::string& key, const std::string& found, const std::string& allowed)
  {
    if (!good)
      faults_ << "\n" << handle_.resolveName(key) << ": found " << found << "; allowed is " << allowed;
  }

  template <typename Convert>
  void convert(const std::string& key, Convert&& use)
  {
    try
    {
      use();
    }
    catch (const Error& error)
    {
      faults_ << "\n" << handle_.resolveName(key) << ": " << error.what();
    }
  }

  void finish() const
  {
    if (!faults_.str().empty())
      throw Error("bad parameters:" + faults_.str());
  }

private:
  void fault(const std::string& key, const std::string& allowed)
  {
    faults_ << "\n" << handle_.resolveName(key) << ": has the wrong type; allowed is " << allowed;
  }

  ros::NodeHandle handle_;
  std::ostringstream faults_;
};

}  // namespace

FaceParameters read_parameters(const ros::NodeHandle& private_handle)
{
  Reader reader(private_handle);
  FaceParameters out;
  out.scene = reader.text("scene", "");
  out.model = reader.text("model", "");
  reader.check(out.scene.empty() != out.model.empty(), "scene",
               out.scene.empty() ? "neither ~scene nor ~model" : "both",
               "either ~scene (a scene file) or ~model (a baked model)");
  out.mesh_directory = reader.text("mesh_dir", "");
  out.accuracy = reader.text("accuracy", "");
  out.cache = reader.text("cache", default_cache());
  out.program = reader.text("program", "");

  const std::string backend = reader.text("backend", "auto");
  reader.convert("backend", [&] { out.runner.solver.backend = backend_from_name(backend); });
  out.runner.solver.threads = reader.value("threads", 0, "a whole number, 0: one a core");
  reader.check(out.runner.solver.threads >= 0, "threads", std::to_string(out.runner.solver.threads),
               "0 (one a core) or more");

  const std::string pace = reader.text("pace", "real_time");
  if (pace == "real_time")
    out.runner.pace = Pace::real_time;
  else if (pace == "fastest")
    out.runner.pace = Pace::fastest;
  else if (pace == "lock_step")
    out.runner.pace = Pace::lock_step;
  else
    reader.check(false, "pace", "'" + pace + "'", "real_time, fastest or lock_step");

  out.runner.frame_rate = reader.value("frame_rate", 0.0, "a number [1/s], 0: the model's");
  reader.check(std::isfinite(out.runner.frame_rate) && out.runner.frame_rate >= 0, "frame_rate",
               std::to_string(out.runner.frame_rate), "0 (the model's) or more [1/s]");
  GuardSettings guard;
  const int interval = reader.value("guard_interval", -1, "a whole number of steps, 0: no guard");
  reader.check(interval >= -1, "guard_interval", std::to_string(interval), "0 (no guard), more, or -1 (the backend's)");
  guard.interval = std::max(interval, 0);
  out.runner.guard.reset();
  if (interval != 0)
    out.runner.guard = guard;
  const std::string field = reader.text("skin_field", "strain");
  reader.convert("skin_field", [&] { out.skin_field = skin_field_from_name(field); });
  out.face_id = reader.text("face_id", "");
  out.parent_frame = reader.text("parent_frame", "map");
  out.demo = reader.value("demo", false, "true or false");
  out.real_time_factor_warning = reader.value("real_time_factor_warning", 0.5, "a number");
  reader.finish();
  return out;
}

}  // namespace frontalis
