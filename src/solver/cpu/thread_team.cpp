#include "solver/cpu/thread_team.hpp"

#include "frontalis/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace frontalis
{
namespace
{

constexpr int spins_before_yield = 4000;  // number of polls; threads with equal work usually meet within them
constexpr int most_threads = 1024;        // upper limit that catches typing errors

/// An exception ends the program, because a thread that left its task would leave the others waiting in a barrier.
void perform(const std::function<void(int)>& task, int thread) noexcept { task(thread); }

void relax()
{
#if defined(__x86_64__)
  _mm_pause();
#endif
}

}  // namespace

ThreadTeam::ThreadTeam(int threads)
{
  const int count = threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  if (count > most_threads)
    throw Error(fmt::format("{} threads: allowed are 0 (one per core) to {}", count, most_threads));
  try
  {
    for (int t = 1; t < count; ++t)
      workers_.emplace_back([this, t] { work(t); });
    next_size_ = count;
  }
  catch (const std::system_error& error)
  {
    stop();
    throw Error(fmt::format("could not start {} threads: {}", count, error.what()));
  }
}

ThreadTeam::~ThreadTeam() { stop(); }

void ThreadTeam::stop()
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  for (auto& worker : workers_)
    worker.join();
}

void ThreadTeam::resize(int size) { next_size_ = std::clamp(size, 1, static_cast<int>(workers_.size()) + 1); }

void ThreadTeam::run(const std::function<void(int)>& task)
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    task_ = &task;
    size_ = next_size_;  // together with the generation, so that a thread that wakes late takes no former task
    ++generation_;
  }
  wake_.notify_all();
  perform(task, 0);
  barrier();
}

void ThreadTeam::barrier()
{
  const std::uint64_t phase = phase_.load(std::memory_order_acquire);
  const int all = size_;  // read before the arrival, after which the next task may begin
  if (arrived_.fetch_add(1, std::memory_order_acq_rel) + 1 == all)
  {
    arrived_.store(0, std::memory_order_relaxed);
    phase_.store(phase + 1, std::memory_order_release);
    return;
  }
  for (int spin = 0; phase_.load(std::memory_order_acquire) == phase; ++spin)
  {
    if (spin < spins_before_yield)
      relax();
    else
      std::this_thread::yield();
  }
}

void ThreadTeam::work(int thread)
{
  std::uint64_t seen = 0;
  for (;;)
  {
    const std::function<void(int)>* task = nullptr;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      wake_.wait(lock, [&] { return stop_ || generation_ != seen; });
      if (stop_)
        return;
      seen = generation_;
      if (thread >= size_)
        continue;
      task = task_;
    }
    perform(*task, thread);
    barrier();
  }
}

}  // namespace frontalis
