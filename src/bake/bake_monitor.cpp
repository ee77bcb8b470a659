#include "bake/bake_monitor.hpp"

#include <sys/resource.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <exception>
#include <future>
#include <mutex>

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
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  if (report_ != nullptr)
    report_->stages.push_back({ stage_, seconds.count(), 1024.0 * static_cast<double>(usage.ru_maxrss) });
  stage_.clear();
}

void BakeMonitor::found(const std::string& sentence)
{
  if (report_ != nullptr)
    report_->findings.push_back(sentence);
}

void parallel_for(BakeMonitor& monitor, std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t)>& body)
{
  std::atomic<std::size_t> done{ 0 }, failed{ count };  // failed: lowest index whose call threw
  std::exception_ptr failure;
  std::mutex mutex;
  const auto call = [&](std::size_t index)
  {
    // After a failure, calls of lower indices still run, so that the message does not depend on the threads.
    if (index > failed)
      return;
    try
    {
      body(index);
    }
    catch (...)
    {
      const std::lock_guard<std::mutex> lock(mutex);
      if (index < failed)
      {
        failed = index;
        failure = std::current_exception();
      }
    }
  };
  const auto call_range = [&](const tbb::blocked_range<std::size_t>& range)
  {
    for (std::size_t index = range.begin(); index < range.end(); ++index)
      call(index);
    done += range.size();
  };
  tbb::task_group_context context;
  const auto run = [&]
  {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain), call_range, tbb::simple_partitioner(), context);
  };
  std::future<void> loop = std::async(std::launch::async, run);
  try
  {
    while (loop.wait_for(std::chrono::milliseconds(100)) != std::future_status::ready)
      monitor.advance(static_cast<double>(done) / static_cast<double>(count));
  }
  catch (...)
  {
    context.cancel_group_execution();
    loop.wait();
    throw;
  }
  loop.get();
  if (failure)
    std::rethrow_exception(failure);
}

}  // namespace frontalis
