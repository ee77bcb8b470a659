#include "bake/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace frontalis
{

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body, BakeStages* stages)
{
  if (count == 0)
    return;
  std::atomic<std::size_t> next{ 0 };
  std::atomic<bool> stop{ false };
  std::mutex mutex;
  std::condition_variable ended;
  std::size_t running = std::min<std::size_t>(std::max(1u, std::thread::hardware_concurrency()), count);
  std::exception_ptr failure;
  std::size_t failed_at = count;

  const auto work = [&]
  {
    while (!stop)
    {
      const std::size_t index = next++;
      if (index >= count)
        break;
      try
      {
        body(index);
      }
      catch (...)
      {
        // indices are handed out in order, so every lower one is done or running: the lowest failure is always found
        const std::lock_guard<std::mutex> lock(mutex);
        stop = true;
        if (index < failed_at)
        {
          failed_at = index;
          failure = std::current_exception();
        }
      }
    }
    const std::lock_guard<std::mutex> lock(mutex);
    --running;
    ended.notify_one();
  };

  std::vector<std::thread> threads;
  for (std::size_t t = running; t > 0; --t)
    threads.emplace_back(work);
  std::exception_ptr interruption;
  {
    std::unique_lock<std::mutex> lock(mutex);
    while (!ended.wait_for(lock, std::chrono::milliseconds(100), [&] { return running == 0; }))
    {
      if (stages == nullptr || interruption)
        continue;
      lock.unlock();
      try
      {
        stages->advance(static_cast<double>(std::min(next.load(), count)) / static_cast<double>(count));
      }
      catch (...)
      {
        interruption = std::current_exception();
        stop = true;
      }
      lock.lock();
    }
  }
  for (std::thread& thread : threads)
    thread.join();
  if (interruption)
    std::rethrow_exception(interruption);
  if (failure)
    std::rethrow_exception(failure);
}

void parallel_ranges(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body,
                     BakeStages* stages)
{
  parallel_for((count + grain - 1) / grain,
               [&](std::size_t range) { body(range * grain, std::min(count, (range + 1) * grain)); }, stages);
}

}  // namespace frontalis
