#pragma once

#include "frontalis/byte_archive.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace frontalis
{

/// Ratio of the assembled model's highest frequency to its bound at nodes, and when it has to be found again.
class AssembledEstimate
{
public:
  /// Estimate of the squared highest frequency for this bound at nodes. It does not fall with the bound: the node that
  /// sets the bound may soften while the rest of the model does not.
  double frequency_squared(double bound) const;
  /// Ratio of squared frequency to bound; 1 if it is unknown.
  double share() const { return share_; }
  void steps_taken(int steps) { steps_ += steps; }
  /// Finds the ratio again if it is due. `search` computes the squared highest frequency in a number of iterations.
  void renew(const std::vector<float>& activation, const std::vector<float>& asked, double bound,
             const std::function<double(int most_iterations)>& search);
  /// To be called when displacements were set from outside.
  void discard();
  void archive(ByteArchive& archive) { archive(share_)(bound_)(steps_)(steps_valid_)(activation_); }

private:
  double share_ = 1;
  double bound_ = 0;              // at nodes when the ratio was found [1/s2]; 0: not found
  std::int64_t steps_ = 0;        // since then, or since activations changed
  std::int64_t steps_valid_ = 0;  // number of steps for which the ratio is valid
  std::vector<float> activation_;
};

}  // namespace frontalis
