#pragma once

#include "frontalis/bake/bake.hpp"

#include <chrono>
#include <string>

namespace frontalis
{

/// Measures the stages of a bake, collects its findings and asks the caller whether to go on. Used from the thread that
/// called bake() alone.
class BakeMonitor
{
public:
  BakeMonitor(BakeReport* report, const BakeProgress& progress) : report_(report), progress_(progress) {}

  /// Ends the stage before, if there is one, and begins the next.
  void begin(const std::string& stage);
  /// Tells the caller the proportion of the stage that is done; throws Error("interrupted") where it wants to stop.
  void advance(double done);
  void finish();
  /// Adds a sentence to the report's findings.
  void found(const std::string& sentence);

private:
  BakeReport* report_;  ///< null: nobody wants one
  const BakeProgress& progress_;
  std::string stage_;
  std::chrono::steady_clock::time_point begin_;
};

}  // namespace frontalis
