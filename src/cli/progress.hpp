#pragma once

#include <string>

namespace frontalis
{

/// Tells how far work is: one line that is written over where stderr is a terminal, else a line a stage on stdout.
class Progress
{
public:
  Progress();
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `done` from 0 to 1; `remark` is shown behind it on a terminal.
  void update(const std::string& stage, double done, const std::string& remark = {});
  /// Takes the line away.
  void clear();

private:
  bool terminal_;
  std::string stage_;
  std::string shown_;
};

}  // namespace frontalis
