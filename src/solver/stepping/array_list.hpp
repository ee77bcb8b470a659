#pragma once

#include "frontalis/solver/allocation.hpp"

#include <type_traits>
#include <utility>

namespace frontalis
{

/// The arrays of a solver that are not empty, each with the effect that needs it and whether it belongs to the state of
/// the motion (other arrays are constant or computed anew in each step). Solver::allocations() and snapshots both use
/// this list. Arrays that every model has, whatever its effects, are attributed to elasticity.
class ArrayList
{
public:
  struct State
  {
    void* data;  ///< in the memory of the backend
    std::size_t bytes;
  };

  void add(Effect effect, const std::string& what, std::size_t bytes)
  {
    if (bytes > 0)
      allocations_.push_back({ effect, what, bytes });
  }
  template <class T>
  void add(Effect effect, const std::string& what, const std::vector<T>& array)
  {
    add(effect, what, array.capacity() * sizeof(T));
  }
  template <class T>
  void add(const std::string& what, const std::vector<T>& array)
  {
    add(Effect::elasticity, what, array);
  }
  /// Adds an array of the state. Its number of entries must not change during the solver's lifetime.
  template <class T>
  void add_state(Effect effect, const std::string& what, std::vector<T>& array)
  {
    static_assert(std::is_trivially_copyable_v<T>);
    add(effect, what, array);
    add_state(array.data(), array.size() * sizeof(T));
  }
  template <class T>
  void add_state(const std::string& what, std::vector<T>& array)
  {
    add_state(Effect::elasticity, what, array);
  }
  void add_state(void* data, std::size_t bytes)
  {
    if (bytes > 0)
      state_.push_back({ data, bytes });
  }

  const std::vector<State>& state() const { return state_; }
  std::size_t state_bytes() const
  {
    std::size_t sum = 0;
    for (const State& array : state_)
      sum += array.bytes;
    return sum;
  }
  std::vector<Allocation> take_allocations() { return std::move(allocations_); }

private:
  std::vector<Allocation> allocations_;
  std::vector<State> state_;
};

/// The part of a backend that computes an effect.
class EffectPart
{
public:
  virtual ~EffectPart() = default;
  virtual void list_arrays(ArrayList& list) = 0;
  /// Adapts the part to a change of the running effects. An effect that is switched off is set to its state at rest, so
  /// that it starts without a history when it is switched on again.
  virtual void run(EffectSet running) = 0;
  /// Sets the effect's state to that at rest.
  virtual void reset() = 0;

protected:
  EffectPart() = default;
  EffectPart(const EffectPart&) = default;
  EffectPart& operator=(const EffectPart&) = default;
};

}  // namespace frontalis
