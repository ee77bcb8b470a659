#pragma once

#include "frontalis/byte_archive.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

namespace frontalis
{

/// Squared highest frequency of the assembled model, and the decision when to search for it again.
///
/// Between searches the stiffness of the model can grow by at most what the stiffness of its voxels grows. The measure
/// of this is the growth since rest of the bound at nodes: the largest ratio, among all nodes, of the growth of the
/// bounds of the voxels at a node to the node's mass [1/s2] (physics/time_step.hpp).
class AssembledEstimate
{
public:
  /// Factor on the squared frequency that a search finds, until the model has been found steady.
  static constexpr double margin_in_motion = 1.25;
  /// Squared highest frequency at given activations.
  using Search = std::function<double(const std::vector<float>& activation)>;

  bool known() const { return found_ > 0; }
  /// The frequency that the latest search found, with its margin, plus growth, which is not less than it was then.
  double covered(double growth) const;
  /// Estimate at a growth since rest; it is in proportion to covered().
  double frequency_squared(double growth) const;
  /// What the latest search found, with its margin, and the least that a search has found.
  double found() const { return found_; }
  double softest() const { return softest_; }
  /// Whether tissue may still be stiffening after a change of activations or poses.
  bool in_motion() const;
  /// Number of steps until the next search is due, at least 1.
  std::int64_t steps_left() const { return std::max<std::int64_t>(steps_valid_ - steps_, 1); }
  void steps_taken(int steps) { steps_ += steps; }
  /// Searches if this is due, and says whether it did. `activation`: the largest activations until the next call.
  /// `moving`: whether bones move, so that tissue stiffens where no muscle acts. `growth`: at present. `most`: bound at
  /// rest. With the growth it is the largest estimate, and the one if the search finds no number. `closely`: whether
  /// voxels are so close to the limit that tissue in motion needs twice as many searches.
  bool renew(const std::vector<float>& activation, bool moving, double growth, double most, const Search& search,
             bool closely = false);
  /// Forgets what was found. Call it when displacements were set from outside.
  void discard();
  void archive(ByteArchive& archive) { archive(found_)(growth_)(softest_)(latest_)(steps_)(steps_valid_)(activation_); }

private:
  double found_ = 0;               // [1/s2]; 0: unknown
  double growth_ = 0;              // growth since rest at the latest search [1/s2]
  double softest_ = 0;             // the least that a search has found, with its margin [1/s2]
  double latest_ = 0;              // what the latest search found [1/s2]
  std::int64_t steps_ = 0;         // steps since the latest search
  std::int64_t steps_valid_ = 0;   // number of steps for which it is valid
  std::vector<float> activation_;  // of the latest search
};

}  // namespace frontalis
