#include "frontalis/ros/model_source.hpp"

#include "frontalis/error.hpp"

#include <gtest/gtest.h>

#include <poll.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace frontalis
{
namespace
{

namespace fs = std::filesystem;

/// Uses shell scripts in place of the program `frontalis`. Their folder is also the temporary folder.
class ModelSource : public testing::Test
{
protected:
  ModelSource()
  {
    const char* const given = std::getenv("TMPDIR");
    given_ = given ? given : "";
    std::string pattern = (fs::temp_directory_path() / "model_source_test-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
    fs::create_directory(folder_ / "temporary");
    setenv("TMPDIR", (folder_ / "temporary").c_str(), 1);
  }
  ~ModelSource() override
  {
    fs::remove_all(folder_);
    if (given_.empty())
      unsetenv("TMPDIR");
    else
      setenv("TMPDIR", given_.c_str(), 1);
  }

  std::string program(const std::string& body)
  {
    const fs::path path = folder_ / "program";
    std::ofstream(path) << "#!/bin/sh\n" << body << "\n";
    chmod(path.c_str(), 0755);
    return path.string();
  }

  std::string fault(const BakeRequest& request)
  {
    try
    {
      bake_in_process(
          request, [this](const std::string& line) { log_.push_back(line); }, cancelled_);
    }
    catch (const Error& error)
    {
      return error.what();
    }
    return "";
  }

  bool left_nothing() const { return fs::is_empty(folder_ / "temporary"); }

  std::string given_;  ///< value of TMPDIR before the test
  fs::path folder_;
  std::vector<std::string> log_;
  std::atomic<bool> cancelled_{ false };
};

TEST_F(ModelSource, BakesASmallScene)
{
  BakeRequest request;
  request.program = FRONTALIS_PROGRAM;
  request.scene = FRONTALIS_SOURCE_DIRECTORY "/test/ros/small.yaml";
  request.accuracy = "draft";
  const Model model = bake_in_process(
      request, [this](const std::string& line) { log_.push_back(line); }, cancelled_);
  EXPECT_EQ(model.voxels.size(), 2u * 2u * 6u);
  ASSERT_EQ(model.muscles.size(), 1u);
  EXPECT_EQ(model.muscles[0].name, "lift");
  EXPECT_FALSE(log_.empty());
  EXPECT_TRUE(left_nothing());
}

TEST_F(ModelSource, TakesWhatWasBakedBeforeFromTheCache)
{
  BakeRequest request;
  request.program = FRONTALIS_PROGRAM;
  request.scene = FRONTALIS_SOURCE_DIRECTORY "/test/ros/small.yaml";
  request.cache = (folder_ / "cache").string();
  const auto bake = [&]
  {
    log_.clear();
    bake_in_process(
        request, [this](const std::string& line) { log_.push_back(line); }, cancelled_);
    for (const std::string& line : log_)
    {
      if (line.compare(0, 9, "cache    ") == 0)
        return line;
    }
    return std::string();
  };
  EXPECT_NE(bake().find("kept as " + request.cache), std::string::npos);
  EXPECT_NE(bake().find("taken from " + request.cache), std::string::npos);
  setenv("ROS_HOME", "/somewhere", 1);
  EXPECT_EQ(default_cache(), "/somewhere/frontalis");
  unsetenv("ROS_HOME");
}

TEST_F(ModelSource, HandsOnArgumentsWithoutAShell)
{
  BakeRequest request;
  request.program = program("for a in \"$@\"; do echo \"<$a>\"; done; exit 1");
  request.scene = "a scene; $(true).yaml";
  request.mesh_directory = "meshes of mine";
  request.accuracy = "fine";
  fault(request);
  ASSERT_EQ(log_.size(), 8u);
  EXPECT_EQ(log_[0], "<bake>");
  EXPECT_EQ(log_[1], "<a scene; $(true).yaml>");
  EXPECT_EQ(log_[2], "<-o>");
  EXPECT_EQ(log_[5], "<meshes of mine>");
  EXPECT_EQ(log_[6], "<--accuracy>");
  EXPECT_EQ(log_[7], "<fine>");
}

TEST_F(ModelSource, AFailedBakeIsAnErrorWithWhatItSaid)
{
  BakeRequest request;
  request.program = program("echo voxelise ...; echo 'scene.yaml:3: skin: bad' >&2; exit 1");
  EXPECT_EQ(fault(request), "scene.yaml:3: skin: bad");
  EXPECT_EQ(log_.size(), 2u);
  EXPECT_TRUE(left_nothing());
}

TEST_F(ModelSource, ACrashIsAnErrorWithItsSignal)
{
  BakeRequest request;
  request.program = program("kill -SEGV $$");
  EXPECT_NE(fault(request).find("signal 11"), std::string::npos);
  EXPECT_TRUE(left_nothing());
}

TEST_F(ModelSource, ABakeThatWritesNothingIsAnError)
{
  BakeRequest request;
  request.program = program("exit 0");
  EXPECT_NE(fault(request).find("model.vtkhdf"), std::string::npos);
  EXPECT_TRUE(left_nothing());
}

TEST_F(ModelSource, AProgramThatIsNotThereIsAnError)
{
  BakeRequest request;
  request.program = "/nowhere/frontalis";
  EXPECT_NE(fault(request).find("/nowhere/frontalis"), std::string::npos);
  EXPECT_THROW(find_program("/nowhere/frontalis"), Error);
  EXPECT_THROW(find_program(folder_.string()), Error);
  const std::string there = program("exit 0");
  EXPECT_EQ(find_program(there), there);
}

TEST_F(ModelSource, FindsTheProgramBesideTheLibraryOrOnThePath)
{
  EXPECT_TRUE(fs::equivalent(find_program(""), FRONTALIS_PROGRAM));
}

TEST_F(ModelSource, ABakeCanBeInterruptedEvenIfItIgnoresRequestsToEnd)
{
  BakeRequest request;
  request.program = program("trap '' TERM INT; echo started; while :; do sleep 0.1; done");
  std::string fault;
  try
  {
    bake_in_process(
        request, [this](const std::string& line) { cancelled_ = line == "started"; }, cancelled_);
  }
  catch (const Error& error)
  {
    fault = error.what();
  }
  EXPECT_NE(fault.find("interrupted"), std::string::npos);
  EXPECT_TRUE(left_nothing());
}

TEST_F(ModelSource, ABakeEndsWithTheProcessThatStartedIt)
{
  BakeRequest request;
  // the loop ends a program that a failing test leaves behind
  request.program = program("trap '' HUP INT TERM; echo started; for i in $(seq 600); do sleep 1; done");
  // the program inherits the writing end of a pipe: the reading end sees the end of file once no process has it open
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  const pid_t node = fork();
  ASSERT_GE(node, 0);
  if (node == 0)
  {
    bake_in_process(
        request, [&](const std::string&) { EXPECT_EQ(write(ends[1], "s", 1), 1); }, cancelled_);
    _exit(0);
  }
  close(ends[1]);
  char byte = 0;
  EXPECT_EQ(read(ends[0], &byte, 1), 1);  // the program runs
  kill(node, SIGKILL);
  EXPECT_EQ(waitpid(node, nullptr, 0), node);
  pollfd closed{ ends[0], POLLIN, 0 };
  ASSERT_EQ(poll(&closed, 1, 60000), 1);
  EXPECT_EQ(read(ends[0], &byte, 1), 0);
  close(ends[0]);
}

}  // namespace
}  // namespace frontalis
