#pragma once

#include "frontalis/bake/bake.hpp"

#include <chrono>
#include <string>

namespace frontalis
{

/// Measures the stages of a bake, collects its findings and asks the caller whether to go on. Used only by the
/// thread that called bake().
class BakeMonitor
{
public:
  BakeMonitor(BakeReport* report, const BakeProgress& progress) : report_(report), progress_(progress) {}

  /// Ends the current stage, if any, and begins this one.
  void begin(const std::string& stage);
  /// Tells the caller the proportion of the stage that is done; throws Error("interrupted") if it wants to stop.
  void advance(double done);
  void finish();
  /// Adds a sentence to the report's findings.
  void found(const std::string& sentence);

private:
  BakeReport* report_;  ///< null: no report is wanted
  const BakeProgress& progress_;
  std::string stage_;
  std::chrono::steady_clock::time_point begin_;
};

}  // namespace frontalis
