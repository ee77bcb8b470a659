#pragma once

#include "files.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>

namespace frontalis
{

struct ProgramResult
{
  int code = -1;  ///< exit code; -1: ended by a signal
  std::string output;
  std::string errors;
};

/// Runs the program `frontalis` without a terminal. If `interrupt_when` names a file, sends SIGINT once it exists.
inline ProgramResult run_program(std::vector<std::string> arguments, const std::string& interrupt_when = {})
{
  const TemporaryFolder folder;
  const std::string output = folder / "output";
  const std::string errors = folder / "errors";
  arguments.insert(arguments.begin(), FRONTALIS_PROGRAM);
  std::vector<char*> pointers;
  for (std::string& argument : arguments)
    pointers.push_back(argument.data());
  pointers.push_back(nullptr);

  const pid_t child = fork();
  if (child == 0)
  {
    dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
    dup2(open(output.c_str(), O_WRONLY | O_CREAT, 0600), STDOUT_FILENO);
    dup2(open(errors.c_str(), O_WRONLY | O_CREAT, 0600), STDERR_FILENO);
    execv(pointers[0], pointers.data());
    _exit(127);
  }
  int status = 0;
  bool sent = interrupt_when.empty();
  while (waitpid(child, &status, sent ? 0 : WNOHANG) == 0)
  {
    if (std::filesystem::exists(interrupt_when))
    {
      kill(child, SIGINT);
      sent = true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  ProgramResult result;
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  result.output = text_of(output);
  result.errors = text_of(errors);
  return result;
}

/// The JSON in a file or in the output of the program. The test fails if it is not valid.
inline nlohmann::json json_from(const std::string& text)
{
  nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  EXPECT_FALSE(json.is_discarded()) << text;
  return json;
}

inline void expect_contains(const std::string& text, const std::string& part)
{
  EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in\n" << text;
}

}  // namespace frontalis
