#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace frontalis
{

/// Threads that run one task together, with a barrier that is cheap enough to be used in every step: it spins
/// briefly, then yields.
class ThreadTeam
{
public:
  /// threads: 0 takes one per core. Throws Error where they cannot be had.
  explicit ThreadTeam(int threads);
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  int size() const { return static_cast<int>(workers_.size()) + 1; }
  /// Runs task(thread) on every thread, the caller being thread 0; returns when all are done. The task must not throw.
  void run(const std::function<void(int)>& task);
  /// Waits for all threads of the team; called from inside a task by each of them.
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
  std::atomic<int> arrived_{ 0 };
  std::atomic<std::uint64_t> phase_{ 0 };
};

}  // namespace frontalis
