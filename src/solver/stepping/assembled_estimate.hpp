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
/// Between searches the stiffness of the model can grow by at most what the stiffness of its voxels grows. Backends
/// measure this at each node as the bound (physics/time_step.hpp) times found / (bound at the search), where that is
/// below 1: at the search the largest of these figures is at most what the search found, and later it grows as the
/// stiffness around any node grows that could set the time step [1/s2]. After searches that confirm each other a node
/// has the smallest of its factors, which are of different moments; that nodes which were stiff one after the other may
/// be so at once is left to the margin.
class AssembledEstimate
{
public:
  /// Factor on the squared frequency that a search finds, until the model has been found steady.
  static constexpr double margin_in_motion = 1.25;
  /// Squared highest frequency at given activations.
  using Search = std::function<double(const std::vector<float>& activation)>;
  struct Renewal
  {
    bool searched = false;
    /// Whether the search found what the one before had found, while no bone moves and no activation exceeds those
    /// searched for. What was measured since then therefore was not growth of the highest frequency, however much it
    /// was.
    bool confirmed = false;
  };

  bool known() const { return found_ > 0; }
  /// What the latest search found, with its margin, or what backends measure since, with a tenth for what the search
  /// may have missed, if that is more.
  double covered(double measured) const;
  double latest() const { return latest_; }    ///< what the latest search returned, without margin
  double softest() const { return softest_; }  ///< the least that a search has found, with its margin
  /// Whether tissue may still be stiffening after a change of activations or poses.
  bool in_motion() const;
  /// Number of steps until the next search is due at the latest, at least 1.
  std::int64_t steps_left() const { return std::max<std::int64_t>(steps_valid_ - steps_, 1); }
  /// Counts steps that were at most as long as `covered` allowed [1/s2].
  void steps_taken(int steps, double covered);
  /// Searches if this is due. `activation`: the largest activations until the next call. `moving`: whether bones move,
  /// so that tissue stiffens where no muscle acts. `measured`: at present. `most`: bound at rest, the estimate if the
  /// search finds no number.
  Renewal renew(const std::vector<float>& activation, bool moving, double measured, double most, const Search& search);
  /// Forgets what was found. Call it when displacements were set from outside.
  void discard();
  void archive(ByteArchive& archive)
  {
    archive(found_)(softest_)(latest_)(steps_)(steps_valid_)(steps_lost_)(activation_);
  }

private:
  double found_ = 0;               // [1/s2]; 0: unknown
  double softest_ = 0;             // the least that a search has found, with its margin [1/s2]
  double latest_ = 0;              // what the latest search found [1/s2]
  std::int64_t steps_ = 0;         // steps since the latest search
  std::int64_t steps_valid_ = 0;   // number of steps for which it is valid
  double steps_lost_ = 0;          // number of steps since beyond those that the estimate alone would have needed
  std::vector<float> activation_;  // of the latest search
};

}  // namespace frontalis
