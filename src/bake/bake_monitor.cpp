#include "bake/bake_monitor.hpp"

#include "bake/available_memory.hpp"
#include "frontalis/error.hpp"

namespace frontalis
{

void BakeMonitor::begin(const std::string& stage)
{
  finish();
  stage_ = stage;
  begin_ = std::chrono::steady_clock::now();
  advance(0);
}

void BakeMonitor::advance(double done)
{
  if (progress_ && !progress_(stage_, done))
    throw Error("interrupted");
}

void BakeMonitor::finish()
{
  if (stage_.empty())
    return;
  advance(1);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin_;
  if (report_ != nullptr)
    report_->stages.push_back({ stage_, seconds.count(), peak_memory() });
  stage_.clear();
}

void BakeMonitor::found(const std::string& sentence)
{
  if (report_ != nullptr)
    report_->findings.push_back(sentence);
}

}  // namespace frontalis
