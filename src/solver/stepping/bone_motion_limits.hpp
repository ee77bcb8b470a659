#pragma once

#include "frontalis/byte_archive.hpp"
#include "frontalis/model/model.hpp"

#include <vector>

namespace frontalis
{

/// What the motion of bones asks of the time step.
class BoneMotionLimits
{
public:
  using Poses = std::vector<RigidTransform>;

  explicit BoneMotionLimits(const Model& model);

  /// Longest step [s] in which no bone moves by more than a tenth of a voxel: tissue that hangs on a faster one would
  /// be turned inside out before the time step follows it.
  double longest_step(const Poses& from, const Poses& to, double seconds) const;
  /// Whether a bone's velocity jumps where this motion begins, by more than half a percent of a voxel per step. That is
  /// about a hundredth of the speed of sound, which goes through half a voxel or so in a safe step.
  bool jumps(const Poses& from, const Poses& to, double seconds, double step) const;
  /// The motion has begun: it is what the next is compared with.
  void moved(const Poses& from, double seconds);
  void archive(ByteArchive& archive) { archive(before_)(seconds_); }

private:
  double shortest_edge_;
  std::array<double, 3> far_corner_;
  Poses before_;        // at the begin of the latest motion
  double seconds_ = 0;  // that it took; 0: there was none
};

}  // namespace frontalis
