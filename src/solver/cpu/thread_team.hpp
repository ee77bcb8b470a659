#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace frontalis
{

/// Threads that run one task together. Their barrier is fast enough for every time step, because it polls briefly
/// before it yields.
class ThreadTeam
{
public:
  /// `threads`: 0 takes one per core. Throws Error if the threads cannot be started.
  explicit ThreadTeam(int threads);
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  /// The number of threads that work, at first all.
  int size() const { return next_size_; }
  /// Lets the first `size` threads work in following tasks, and the others sleep. Not to be called inside a task.
  void resize(int size);
  /// Runs task(thread) on every working thread and returns when all are done. The caller is thread 0. The task must not
  /// throw.
  void run(const std::function<void(int)>& task);
  /// Waits for all working threads. Each thread must call barrier() from inside the task.
  void barrier();

private:
  void work(int thread);
  void stop();

  std::vector<std::thread> workers_;
  std::mutex mutex_;
  std::condition_variable wake_;
  const std::function<void(int)>* task_ = nullptr;
  std::uint64_t generation_ = 0;
  bool stop_ = false;
  int size_ = 1;       // of the task that runs or ran last
  int next_size_ = 1;  // of the next one
  std::atomic<int> arrived_{ 0 };
  std::atomic<std::uint64_t> phase_{ 0 };
};

}  // namespace frontalis
