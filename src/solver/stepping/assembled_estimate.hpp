#pragma once

#include "frontalis/byte_archive.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace frontalis
{

/// Ratio of the assembled model's squared highest frequency to its bound at nodes, and the decision when to compute it
/// again.
class AssembledEstimate
{
public:
  /// Squared highest frequency at given activations.
  using Search = std::function<double(const std::vector<float>& activation)>;

  /// The largest bound at nodes for which the ratio is used: the present bound or, if that is smaller, the bound when
  /// the ratio was found. The estimate does not fall when the bound falls, because the node that sets the bound may
  /// soften while the rest of the model does not.
  double bound_covered(double bound) const;
  /// Estimate of the squared highest frequency, given the present bound at nodes.
  double frequency_squared(double bound) const { return share_ * bound_covered(bound); }
  /// Ratio of squared frequency to bound; 1 if it is unknown.
  double share() const { return share_; }
  void steps_taken(int steps) { steps_ += steps; }
  /// Computes the ratio again if this is due. `activation`: the largest activations until the next call. `moving`:
  /// whether bones move, so that tissue stiffens where no muscle acts.
  void renew(const std::vector<float>& activation, bool moving, double bound, const Search& search);
  /// Discards the ratio. Call it when displacements were set from outside.
  void discard();
  void archive(ByteArchive& archive) { archive(share_)(bound_)(steps_)(steps_valid_)(activation_); }

private:
  double share_ = 1;
  double bound_ = 0;               // bound at nodes when the ratio was found [1/s2]; 0: not found
  std::int64_t steps_ = 0;         // steps since the ratio was found
  std::int64_t steps_valid_ = 0;   // number of steps for which the ratio is valid
  std::vector<float> activation_;  // for which the ratio was found
};

}  // namespace frontalis
