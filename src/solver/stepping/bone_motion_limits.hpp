#pragma once

#include "frontalis/byte_archive.hpp"
#include "frontalis/model/model.hpp"

#include <vector>

namespace frontalis
{

/// Limits that moving bones set to the time step.
class BoneMotionLimits
{
public:
  using Poses = std::vector<RigidTransform>;

  explicit BoneMotionLimits(const Model& model);

  /// Longest step [s] in which no bone moves by more than a tenth of a voxel. A faster bone would invert the tissue
  /// attached to it before the time step adapts.
  double longest_step(const Poses& from, const Poses& to, double seconds) const;
  /// Whether a bone's velocity jumps at the start of this motion, by more than 0.5 % of a voxel per step. That is about
  /// 1 % of the speed of sound, because waves cross about half a voxel in a safe step.
  bool jumps(const Poses& from, const Poses& to, double seconds, double step) const;
  /// Records a motion that has started, with which jumps() compares the next motion.
  void moved(const Poses& from, double seconds);
  void archive(ByteArchive& archive) { archive(before_)(seconds_); }

private:
  double shortest_edge_;
  std::array<double, 3> far_corner_;
  Poses before_;        // at the start of the latest motion
  double seconds_ = 0;  // duration of that motion; 0: there was none
};

}  // namespace frontalis
