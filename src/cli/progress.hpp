#pragma once

#include <boost/timer/progress_display.hpp>

#include <optional>
#include <string>

namespace frontalis
{

/// Tells how far work is: a bar a stage where stderr is a terminal, else a line a stage on stdout.
class Progress
{
public:
  /// Where stderr is no terminal: a line a stage, or nothing.
  enum class OffTerminal
  {
    lines,
    silent
  };
  explicit Progress(OffTerminal off_terminal = OffTerminal::lines);
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `done` from 0 to 1.
  void update(const std::string& stage, double done);
  /// Ends the line of a bar that is not full.
  void clear();

private:
  bool terminal_, lines_;
  std::string stage_;
  std::optional<boost::timer::progress_display> bar_;
};

}  // namespace frontalis
