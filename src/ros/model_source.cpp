#include "frontalis/ros/model_source.hpp"

#include "frontalis/error.hpp"
#include "frontalis/model/model_file.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/process/async_pipe.hpp>
#include <boost/process/child.hpp>
#include <boost/process/exe.hpp>
#include <boost/process/args.hpp>
#include <boost/process/extend.hpp>
#include <boost/process/io.hpp>
#include <boost/process/environment.hpp>
#include <fmt/format.h>

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <mutex>
#include <system_error>
#include <vector>

namespace frontalis
{

namespace
{

namespace asio = boost::asio;
namespace bp = boost::process;
namespace fs = std::filesystem;

constexpr std::chrono::milliseconds cancellation_period(50);  // time between two checks for cancellation

bool is_program(const fs::path& path)
{
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) && access(path.c_str(), X_OK) == 0;
}

/// Reads a pipe to its end and passes on each line. A carriage return ends a line too, because programs that rewrite a
/// line of progress print it instead of a newline.
class LineReader
{
public:
  LineReader(asio::io_context& context, BakeLog use) : pipe_(context), use_(std::move(use))
  {
    // a program started by another thread must not inherit the pipe and keep it open
    for (const int end : { pipe_.native_source(), pipe_.native_sink() })
      fcntl(end, F_SETFD, FD_CLOEXEC);
  }
  bp::async_pipe& pipe() { return pipe_; }
  void read()
  {
    pipe_.async_read_some(asio::buffer(bytes_),
                          [this](const boost::system::error_code& ended, std::size_t count)
                          {
                            for (std::size_t i = 0; i < count; ++i)
                              if (bytes_[i] == '\n' || bytes_[i] == '\r')
                                finish_line();
                              else
                                line_ += bytes_[i];
                            if (ended)
                              finish_line();
                            else
                              read();
                          });
  }

private:
  void finish_line()
  {
    if (!line_.empty())
      use_(line_);
    line_.clear();
  }

  bp::async_pipe pipe_;
  BakeLog use_;
  std::array<char, 4096> bytes_{};
  std::string line_;
};

/// Starts a program and connects its output and error streams to two readers. Throws an Error if it cannot be run.
bp::child start(const std::string& program, const std::vector<std::string>& arguments, LineReader& output,
                LineReader& errors)
{
  const pid_t parent = getpid();
  const auto prepare = [parent](const auto&)
  {
    // the system kills the program when the thread that started it ends, so that it does not outlive a node that dies
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent)
      _exit(EXIT_FAILURE);
    // the program must not inherit the node's set of blocked signals
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    for (int number = 1; number < NSIG; ++number)
      signal(number, SIG_DFL);
  };
  try
  {
    return bp::child(bp::exe = program, bp::args = arguments, bp::std_in<bp::null, bp::std_out> output.pipe(),
                     bp::std_err > errors.pipe(), bp::extend::on_exec_setup = prepare);
  }
  catch (const bp::process_error& error)
  {
    throw Error(fmt::format("{}: cannot be run: {}", program, error.code().message()));
  }
}

}  // namespace

std::string find_program(const std::string& wanted)
{
  if (!wanted.empty())
  {
    if (is_program(wanted))
      return wanted;
    throw Error(wanted + ": is not a program; ~program must be the path of the program frontalis");
  }

  std::vector<fs::path> places;
  std::error_code ignored;
  const fs::path executable = fs::read_symlink("/proc/self/exe", ignored);
  if (!executable.empty())
    places.push_back(executable.parent_path() / "frontalis");
  Dl_info library{};
  if (dladdr(reinterpret_cast<const void*>(&find_program), &library) && library.dli_fname)
    places.push_back(fs::absolute(library.dli_fname, ignored).parent_path() / "frontalis" / "frontalis");
  for (const auto& folder : boost::this_process::path())
    places.push_back(fs::path(folder.string()) / "frontalis");

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

std::shared_ptr<const fs::path> temporary_folder()
{
  std::string pattern = (fs::temp_directory_path() / "frontalis-XXXXXX").string();
  if (!mkdtemp(pattern.data()))
    throw Error(fmt::format("{}: cannot make a temporary folder: {}", pattern, std::strerror(errno)));
  return { new fs::path(pattern), [](const fs::path* path)
           {
             std::error_code ignored;
             fs::remove_all(*path, ignored);
             delete path;
           } };
}

void run_program(const std::string& program, const std::vector<std::string>& arguments, const BakeLog& log,
                 const std::atomic<bool>& cancelled)
{
  const std::string command = program + " " + arguments.front();
  static std::mutex starting;  // held until the program runs, so that no other program inherits these pipes
  std::unique_lock<std::mutex> lock(starting);
  asio::io_context context;
  std::string said;
  LineReader output(context, log);
  LineReader errors(context,
                    [&](const std::string& line)
                    {
                      said += (said.empty() ? "" : "\n") + line;
                      log(line);
                    });
  bp::child child = start(program, arguments, output, errors);
  lock.unlock();

  output.read();
  errors.read();
  while (!context.stopped() && !cancelled)  // the context stops when both streams have ended
    context.run_for(cancellation_period);
  // child.terminate() would leave a zombie process, since it does not wait
  if (cancelled)
    kill(child.id(), SIGKILL);
  std::error_code fault;
  child.wait(fault);
  if (cancelled)
    throw Error(command + " was interrupted");
  if (fault)
    throw Error(fmt::format("{}: its exit status cannot be read: {}", program, fault.message()));
  const int status = child.native_exit_code();
  if (WIFSIGNALED(status))
    throw Error(fmt::format("{}: ended by signal {} ({}){}{}", command, WTERMSIG(status), strsignal(WTERMSIG(status)),
                            said.empty() ? "" : "\n", said));
  if (child.exit_code() != 0)
    throw Error(said.empty() ? fmt::format("{}: ended with exit status {}", command, child.exit_code()) : said);
}

void add_scene_arguments(const BakeRequest& request, std::vector<std::string>& arguments)
{
  for (const auto& [option, value] : { std::pair{ "--mesh-dir", request.mesh_directory },
                                       { "--accuracy", request.accuracy },
                                       { "--cache", request.cache } })
    if (!value.empty())
      arguments.insert(arguments.end(), { option, value });
}

Model bake_in_process(const BakeRequest& request, const BakeLog& log, const std::atomic<bool>& cancelled)
{
  const auto folder = temporary_folder();
  const std::string file = (*folder / "model.vtkhdf").string();
  std::vector<std::string> arguments{ "bake", request.scene, "-o", file };
  add_scene_arguments(request, arguments);
  run_program(request.program, arguments, log, cancelled);
  return read_model(file);
}

}  // namespace frontalis
