#pragma once

#include "device_on_host.hpp"

#include <ucontext.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <vector>

/// Runs the 32 lanes of a warp on the host, in turn. A lane runs until it exchanges a value with other lanes, and goes
/// on when all of them have offered theirs.
class WarpOnHost
{
public:
  static constexpr int lanes = 32;

  /// Calls program(lane) on all lanes.
  explicit WarpOnHost(std::function<void(int)> program) : program_(std::move(program))
  {
    current() = this;
    for (Lane& lane : lane_)
      prepare(lane);
    for (int left = lanes; left > 0;)
      for (now_ = 0; now_ < lanes; ++now_)
        if (!lane_[now_].done)
        {
          swapcontext(&main_, &lane_[now_].context);
          left -= lane_[now_].done ? 1 : 0;
        }
    current() = nullptr;
  }

  static int lane() { return current()->now_; }
  /// Without a warp there is one thread.
  static ThreadOnHost thread() { return { current() == nullptr ? 0u : static_cast<std::uint32_t>(lane()) }; }
  /// Offers a value to other lanes, and returns that of the lane `from`.
  template <class T>
  static T exchange(T value, int from)
  {
    WarpOnHost& warp = *current();
    Lane& own = warp.lane_[warp.now_];
    const int turn = own.turn;
    own.turn = 1 - turn;
    static_assert(sizeof(T) <= sizeof(own.offered[0]));
    std::memcpy(&own.offered[turn], &value, sizeof value);
    swapcontext(&own.context, &warp.main_);
    std::memcpy(&value, &warp.lane_[from].offered[turn], sizeof value);
    return value;
  }

  /// Waits for all lanes.
  static void barrier()
  {
    WarpOnHost& warp = *current();
    Lane& own = warp.lane_[warp.now_];
    const int round = warp.round_;
    if (++warp.arrived_ == lanes)
    {
      warp.arrived_ = 0;
      ++warp.round_;
    }
    while (warp.round_ == round)
      swapcontext(&own.context, &warp.main_);
    own.turn = 0;
  }

private:
  struct Lane
  {
    ucontext_t context;
    std::vector<char> stack;
    std::array<std::uint64_t, 2> offered{};  // the value of the latest exchange and of the one before
    int turn = 0;
    bool done = false;
  };

  void prepare(Lane& lane)
  {
    lane.stack.resize(std::size_t{ 1 } << 18);
    getcontext(&lane.context);
    lane.context.uc_stack.ss_sp = lane.stack.data();
    lane.context.uc_stack.ss_size = lane.stack.size();
    lane.context.uc_link = &main_;
    makecontext(&lane.context, start, 0);
  }
  static WarpOnHost*& current()
  {
    static WarpOnHost* warp = nullptr;
    return warp;
  }
  static void start()
  {
    WarpOnHost& warp = *current();
    warp.program_(warp.now_);
    warp.lane_[warp.now_].done = true;
  }

  std::function<void(int)> program_;
  ucontext_t main_{};
  std::array<Lane, lanes> lane_{};
  int now_ = 0;
  int arrived_ = 0, round_ = 0;  // lanes at the present barrier, and number of barriers before
};

#define threadIdx WarpOnHost::thread()

template <class T>
static inline T __shfl_sync(std::uint32_t, T value, int from)
{
  return WarpOnHost::exchange(value, from);
}
// Like on a GPU, the last lane gets its own value.
template <class T>
static inline T __shfl_down_sync(std::uint32_t, T value, int by)
{
  return WarpOnHost::exchange(value, std::min(WarpOnHost::lane() + by, WarpOnHost::lanes - 1));
}
template <class T>
static inline T __shfl_xor_sync(std::uint32_t, T value, int mask)
{
  return WarpOnHost::exchange(value, WarpOnHost::lane() ^ mask);
}
using std::max;
