#include "frontalis/ros/model_source.hpp"

#include "frontalis/error.hpp"
#include "frontalis/model/model_file.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <vector>

extern char** environ;

namespace frontalis
{

namespace
{

namespace fs = std::filesystem;

bool is_program(const fs::path& path)
{
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) && access(path.c_str(), X_OK) == 0;
}

/// A folder under the system's temporary folder, removed with what is in it.
class TemporaryFolder
{
public:
  TemporaryFolder()
  {
    std::string pattern = (fs::temp_directory_path() / "frontalis-XXXXXX").string();
    if (!mkdtemp(pattern.data()))
      throw Error(pattern + ": cannot make a temporary folder: " + std::strerror(errno));
    path_ = pattern;
  }
  ~TemporaryFolder()
  {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const fs::path& path() const { return path_; }

private:
  fs::path path_;
};

/// Both ends of a pipe, closed when it goes.
struct Pipe
{
  int ends[2] = { -1, -1 };

  Pipe()
  {
    if (pipe2(ends, O_CLOEXEC) != 0)
      throw Error(std::string("cannot make a pipe: ") + std::strerror(errno));
  }
  ~Pipe()
  {
    close_end(0);
    close_end(1);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  void close_end(int end)
  {
    if (ends[end] >= 0)
      close(ends[end]);
    ends[end] = -1;
  }
};

/// Cuts a stream of bytes into lines; a carriage return ends a line too.
class Lines
{
public:
  explicit Lines(std::function<void(const std::string&)> use) : use_(std::move(use)) {}
  void add(const char* bytes, std::size_t count)
  {
    for (std::size_t i = 0; i < count; ++i)
      if (bytes[i] == '\n' || bytes[i] == '\r')
        finish();
      else
        line_ += bytes[i];
  }
  void finish()
  {
    if (!line_.empty())
      use_(line_);
    line_.clear();
  }

private:
  std::function<void(const std::string&)> use_;
  std::string line_;
};

pid_t spawn(const std::vector<std::string>& arguments, const Pipe& output, const Pipe& errors)
{
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, output.ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, errors.ends[1], STDERR_FILENO);

  // signals as a fresh process has them, whatever the node blocks or ignores
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);

  std::vector<char*> pointers;
  pointers.reserve(arguments.size() + 1);
  for (const auto& argument : arguments)
    pointers.push_back(const_cast<char*>(argument.c_str()));
  pointers.push_back(nullptr);
  pid_t child = -1;
  const int fault = posix_spawn(&child, pointers[0], &actions, &attributes, pointers.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (fault != 0)
    throw Error(arguments[0] + ": cannot be run: " + std::strerror(fault));
  return child;
}

/// Hands on what the child writes until it has closed both streams; ends the child once `cancelled` is true.
void follow(pid_t child, Pipe& output, Pipe& errors, Lines& output_lines, Lines& error_lines,
            const std::atomic<bool>& cancelled)
{
  bool ended = false;
  while (output.ends[0] >= 0 || errors.ends[0] >= 0)
  {
    if (cancelled && !ended)
    {
      kill(child, SIGTERM);
      ended = true;
    }
    std::array<pollfd, 2> watched{ { { output.ends[0], POLLIN, 0 }, { errors.ends[0], POLLIN, 0 } } };
    if (poll(watched.data(), watched.size(), 100) < 0 && errno != EINTR)
      return;
    for (int stream = 0; stream < 2; ++stream)
    {
      if (!(watched[stream].revents & (POLLIN | POLLHUP | POLLERR)))
        continue;
      char buffer[4096];
      const ssize_t count = read(watched[stream].fd, buffer, sizeof buffer);
      if (count > 0)
        (stream == 0 ? output_lines : error_lines).add(buffer, static_cast<std::size_t>(count));
      else if (count == 0 || errno != EINTR)
        (stream == 0 ? output : errors).close_end(0);
    }
  }
}

/// Runs a program to its end. Throws Error where it does not end with 0.
void run(const std::vector<std::string>& arguments, const BakeLog& log, const std::atomic<bool>& cancelled)
{
  Pipe output, errors;
  const pid_t child = spawn(arguments, output, errors);
  output.close_end(1);
  errors.close_end(1);

  std::string said;
  Lines output_lines([&](const std::string& line) { log(line); });
  Lines error_lines(
      [&](const std::string& line)
      {
        said += (said.empty() ? "" : "\n") + line;
        log(line);
      });
  follow(child, output, errors, output_lines, error_lines, cancelled);
  output_lines.finish();
  error_lines.finish();

  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR)
      throw Error(arguments[0] + ": lost sight of the process: " + std::strerror(errno));
  if (cancelled)
    throw Error("the bake was interrupted");
  if (WIFSIGNALED(status))
    throw Error(arguments[0] + " bake: ended by signal " + std::to_string(WTERMSIG(status)) + " (" +
                strsignal(WTERMSIG(status)) + ")" + (said.empty() ? "" : "\n" + said));
  if (WEXITSTATUS(status) != 0)
    throw Error(said.empty() ? arguments[0] + " bake: ended with " + std::to_string(WEXITSTATUS(status)) : said);
}

}  // namespace

std::string find_program(const std::string& wanted)
{
  if (!wanted.empty())
  {
    if (is_program(wanted))
      return wanted;
    throw Error(wanted + ": no program there; ~program must be the path of the program frontalis");
  }

  std::vector<fs::path> places;
  std::error_code ignored;
  const fs::path executable = fs::read_symlink("/proc/self/exe", ignored);
  if (!executable.empty())
    places.push_back(executable.parent_path() / "frontalis");
  Dl_info library{};
  if (dladdr(reinterpret_cast<const void*>(&find_program), &library) && library.dli_fname)
    places.push_back(fs::absolute(library.dli_fname, ignored).parent_path() / "frontalis" / "frontalis");
  const char* const path = std::getenv("PATH");
  std::string folders = path ? path : "";
  for (std::size_t begin = 0; begin < folders.size();)
  {
    const std::size_t end = std::min(folders.find(':', begin), folders.size());
    if (end > begin)
      places.push_back(fs::path(folders.substr(begin, end - begin)) / "frontalis");
    begin = end + 1;
  }

  std::string tried;
  for (const auto& place : places)
  {
    if (is_program(place))
      return place.string();
    tried += "\n  " + place.string();
  }
  throw Error("the program frontalis was not found; set ~program to its path. Tried:" + tried);
}

std::string default_cache()
{
  if (const char* const ros_home = std::getenv("ROS_HOME"))
    return std::string(ros_home) + "/frontalis";
  const char* const home = std::getenv("HOME");
  return home != nullptr ? std::string(home) + "/.ros/frontalis" : "";
}

Model bake_in_process(const BakeRequest& request, const BakeLog& log, const std::atomic<bool>& cancelled)
{
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "model.vtkhdf").string();
  std::vector<std::string> arguments{ request.program, "bake", request.scene, "-o", file };
  if (!request.mesh_directory.empty())
    arguments.insert(arguments.end(), { "--mesh-dir", request.mesh_directory });
  if (!request.accuracy.empty())
    arguments.insert(arguments.end(), { "--accuracy", request.accuracy });
  if (!request.cache.empty())
    arguments.insert(arguments.end(), { "--cache", request.cache });
  run(arguments, log, cancelled);
  return read_model(file);
}

}  // namespace frontalis
