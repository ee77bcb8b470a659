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
  /// Estimate of the squared highest frequency, given the present bound at nodes. The estimate does not fall when the
  /// bound falls, because the node that sets the bound may soften while the rest of the model does not.
  double frequency_squared(double bound) const;
  /// Ratio of squared frequency to bound; 1 if it is unknown.
  double share() const { return share_; }
  void steps_taken(int steps) { steps_ += steps; }
  /// Computes the ratio again if this is due. `asked`: commanded activations; `search` returns the squared highest
  /// frequency after at most the given number of iterations.
  void renew(const std::vector<float>& activation, const std::vector<float>& asked, double bound,
             const std::function<double(int most_iterations)>& search);
  /// Discards the ratio. Call it when displacements were set from outside.
  void discard();
  void archive(ByteArchive& archive) { archive(share_)(bound_)(steps_)(steps_valid_)(activation_); }

private:
  double share_ = 1;
  double bound_ = 0;              // bound at nodes when the ratio was found [1/s2]; 0: not found
  std::int64_t steps_ = 0;        // steps since the ratio was found, or since activations changed
  std::int64_t steps_valid_ = 0;  // number of steps for which the ratio is valid
  std::vector<float> activation_;
};

}  // namespace frontalis
