#pragma once

#include "frontalis/byte_archive.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace frontalis
{

/// How much the highest frequency of the assembled model is below its bound at nodes, and when it has to be found
/// again.
class AssembledEstimate
{
public:
  struct State
  {
    double share = 1;              ///< of the bound at nodes, both squared; 1: nothing is known
    double bound = 0;              ///< at nodes when the share was found [1/s2]; 0: it was not
    std::int64_t steps = 0;        ///< since then, or since activations changed
    std::int64_t steps_valid = 0;  ///< that it may be relied on
    std::vector<float> activation;

    void archive(ByteArchive& archive) { archive(share)(bound)(steps)(steps_valid)(activation); }
  };

  /// Frequency squared to go by where the bound at nodes is this: what softens where that bound is set need not soften
  /// in the assembled model.
  double frequency_squared(double bound) const;
  double share() const { return state_.share; }
  void steps_taken(int steps) { state_.steps += steps; }
  /// Finds the share again if it is due. `search` gives the highest frequency squared from a number of iterations.
  void renew(const std::vector<float>& activation, const std::vector<float>& asked, double bound,
             const std::function<double(int most_iterations)>& search);
  /// Displacements were set from outside.
  void discard();

  const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }

private:
  State state_;
};

}  // namespace frontalis
