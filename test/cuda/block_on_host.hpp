#pragma once

#include <ucontext.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <functional>
#include <vector>

/// Runs the threads of a block on the host, in turn. A thread runs until it waits for others, and goes on when all of
/// them have had their turn. Without a block there is one thread, and the other lanes of its warp have only zeros.
class BlockOnHost
{
public:
  struct Index
  {
    std::uint32_t x;
  };
  static constexpr std::uint32_t lanes = 32;

  /// Calls program() in each of `threads` threads, a multiple of 32.
  explicit BlockOnHost(std::function<void()> program, std::uint32_t threads = lanes)
      : program_(std::move(program)), threads_(threads)
  {
    current() = this;
    for (Thread& thread : threads_)
      prepare(thread);
    for (std::uint32_t left = threads; left > 0;)
      for (now_ = 0; now_ < threads; ++now_)
        if (!threads_[now_].done)
        {
          swapcontext(&main_, &threads_[now_].context);
          left -= threads_[now_].done ? 1 : 0;
        }
    current() = nullptr;
  }

  static Index thread() { return { current() == nullptr ? 0 : current()->now_ }; }
  static Index size() { return { current() == nullptr ? 1 : static_cast<std::uint32_t>(current()->threads_.size()) }; }
  /// Lets all other threads have a turn.
  static void wait()
  {
    if (BlockOnHost* const block = current())
      swapcontext(&block->threads_[block->now_].context, &block->main_);
  }
  /// Offers a value to the other lanes of the warp, and returns that of the lane from(own lane).
  template <class T, class From>
  static T exchange(T value, const From& from)
  {
    if (current() == nullptr)
      return T(0);
    BlockOnHost& block = *current();
    Thread& own = block.threads_[block.now_];
    const int turn = own.turn;
    own.turn = 1 - turn;
    static_assert(sizeof(T) <= sizeof(own.offered[0]));
    std::memcpy(&own.offered[turn], &value, sizeof value);
    wait();
    const std::uint32_t lane = block.now_ % lanes;
    std::memcpy(&value, &block.threads_[block.now_ - lane + from(lane)].offered[turn], sizeof value);
    return value;
  }
  /// Waits for all threads. Returns whether one of them has called it with `any`.
  static bool barrier(bool any = false)
  {
    if (current() == nullptr)
      return any;
    BlockOnHost& block = *current();
    const std::uint32_t round = block.round_;
    bool& voted = block.voted_[round % 2];
    voted = voted || any;
    if (++block.arrived_ == block.threads_.size())
    {
      block.arrived_ = 0;
      ++block.round_;
      block.voted_[block.round_ % 2] = false;
    }
    while (block.round_ == round)
      wait();
    block.threads_[block.now_].turn = 0;
    return voted;
  }

private:
  struct Thread
  {
    ucontext_t context;
    std::vector<char> stack;
    std::array<std::uint64_t, 2> offered{};  // the value of the latest exchange and of the one before
    int turn = 0;
    bool done = false;
  };

  void prepare(Thread& thread)
  {
    thread.stack.resize(std::size_t{ 1 } << 18);
    getcontext(&thread.context);
    thread.context.uc_stack.ss_sp = thread.stack.data();
    thread.context.uc_stack.ss_size = thread.stack.size();
    thread.context.uc_link = &main_;
    makecontext(&thread.context, start, 0);
  }
  static BlockOnHost*& current()
  {
    static BlockOnHost* block = nullptr;
    return block;
  }
  static void start()
  {
    BlockOnHost& block = *current();
    block.program_();
    block.threads_[block.now_].done = true;
  }

  std::function<void()> program_;
  ucontext_t main_{};
  std::vector<Thread> threads_;
  std::uint32_t now_ = 0;
  std::uint32_t arrived_ = 0, round_ = 0;  // threads at the present barrier, and number of barriers before
  std::array<bool, 2> voted_{};            // of the present barrier and of the one before
};
