#pragma once

#include <boost/timer/progress_display.hpp>

#include <cstdio>
#include <optional>
#include <string>

namespace frontalis
{

/// Shows the progress of work, with one bar per stage if stderr is a terminal, else with one line per stage.
class Progress
{
public:
  /// `lines`: stream for lines if stderr is not a terminal; null: no lines.
  explicit Progress(std::FILE* lines = stdout);
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `done`: completed fraction of the stage, 0 to 1.
  void update(const std::string& stage, double done);
  /// Ends the line of an unfinished bar.
  void clear();

private:
  bool terminal_;
  std::FILE* lines_;
  std::string stage_;
  std::optional<boost::timer::progress_display> bar_;
};

}  // namespace frontalis
