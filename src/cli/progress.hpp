#pragma once

#include <boost/timer/progress_display.hpp>

#include <optional>
#include <string>

namespace frontalis
{

/// Shows the progress of work: one bar per stage where stderr is a terminal, else one line per stage on stdout.
class Progress
{
public:
  /// What is shown where stderr is no terminal.
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
  /// Ends the line of an unfinished bar.
  void clear();

private:
  bool terminal_, lines_;
  std::string stage_;
  std::optional<boost::timer::progress_display> bar_;
};

}  // namespace frontalis
