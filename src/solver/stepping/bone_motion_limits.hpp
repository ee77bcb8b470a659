#pragma once

#include "frontalis/byte_archive.hpp"
#include "frontalis/model/model.hpp"

#include <vector>

namespace frontalis
{

/// Limits of the speed of bones and of plans, and signs of jumps.
class BoneMotionLimits
{
public:
  using Poses = std::vector<RigidTransform>;

  /// critical_step: critical time step of the model at rest [s]
  BoneMotionLimits(const Model& model, double critical_step);

  /// The poses that bones reach on their way to `to` in this time. No part of a bone that holds tissue moves by more
  /// than a tenth of a voxel in a critical step, about a fifth of the speed of sound. A faster bone would invert the
  /// tissue attached to it, and fling nodes of little mass away.
  Poses reached(const Poses& from, const Poses& to, double seconds) const;
  /// Whether a bone's velocity jumps at the start of this motion, by more than 0.5 % of a voxel per step. That is about
  /// 1 % of the speed of sound, because waves cross about half a voxel in a safe step.
  bool jumps(const Poses& from, const Poses& to, double seconds, double step) const;
  /// Longest plan [s] in a motion of this duration: bones move by at most half of a voxel, because the tissue beside
  /// them may stiffen as they move. Infinite if the whole motion is no longer than that.
  double longest_plan(const Poses& from, const Poses& to, double seconds) const;
  /// Records a motion that has started, with which jumps() compares the next motion.
  void moved(const Poses& from, double seconds);
  void archive(ByteArchive& archive) { archive(before_)(seconds_)(top_speed_); }

private:
  // A box around the tissue that a bone can move.
  struct Reach
  {
    std::array<double, 3> lower, upper;

    double fastest_way(const RigidTransform& from, const RigidTransform& to) const;  // of a corner of the box [m]
    void include(const std::array<double, 3>& p);
  };

  /// Longest path of a bone, in shortest voxel edges.
  double edges(const Poses& from, const Poses& to) const;

  double shortest_edge_;
  double top_speed_;  // [m/s]
  std::vector<Reach> reach_;
  Poses before_;        // at the start of the latest motion
  double seconds_ = 0;  // duration of that motion; 0: there was none
};

}  // namespace frontalis
