#pragma once

#include "frontalis/bake/bake.hpp"

#include <chrono>
#include <string>

namespace frontalis
{

/// Where the bake stands: times its stages, collects findings, asks whether to go on. Used from the calling thread
/// alone.
class BakeStages
{
public:
  BakeStages(BakeReport* report, const BakeProgress& progress) : report_(report), progress_(progress) {}

  void begin(const std::string& name)
  {
    finish();
    name_ = name;
    begin_ = std::chrono::steady_clock::now();
    advance(0);
  }
  /// Throws Error("interrupted") where the caller wants to stop.
  void advance(double done);
  void finish();
  void found(const std::string& sentence)
  {
    if (report_ != nullptr)
      report_->findings.push_back(sentence);
  }

private:
  BakeReport* report_;
  const BakeProgress& progress_;
  std::string name_;
  std::chrono::steady_clock::time_point begin_;
};

}  // namespace frontalis
