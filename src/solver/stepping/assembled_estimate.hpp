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
  /// Estimate of the highest frequency squared where the bound at nodes is this. It does not fall with the bound: the
  /// node that sets the bound may soften while the rest of the model does not.
  double frequency_squared(double bound) const;
  /// Of the bound, both squared; 1 where nothing is known.
  double share() const { return share_; }
  void steps_taken(int steps) { steps_ += steps; }
  /// Finds the share again if it is due. `search` gives the highest frequency squared from a number of iterations.
  void renew(const std::vector<float>& activation, const std::vector<float>& asked, double bound,
             const std::function<double(int most_iterations)>& search);
  /// Displacements were set from outside.
  void discard();
  void archive(ByteArchive& archive) { archive(share_)(bound_)(steps_)(steps_valid_)(activation_); }

private:
  double share_ = 1;
  double bound_ = 0;              // at nodes when the share was found [1/s2]; 0: it was not
  std::int64_t steps_ = 0;        // since then, or since activations changed
  std::int64_t steps_valid_ = 0;  // that the share may be relied on
  std::vector<float> activation_;
};

}  // namespace frontalis
