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
  struct State
  {
    Poses before;        ///< at the begin of the latest motion
    double seconds = 0;  ///< that it took; 0: there was none

    void archive(ByteArchive& archive) { archive(before)(seconds); }
  };

  explicit BoneMotionLimits(const Model& model);

  /// Longest step [s] in which no bone moves by more than a tenth of a voxel: tissue that hangs on a faster one would
  /// be turned inside out before the time step follows it.
  double longest_step(const Poses& from, const Poses& to, double seconds) const;
  /// Whether a bone's velocity jumps where this motion begins: by more than half a percent of a voxel per step, which
  /// is about a hundredth of the speed of sound in tissue, because a safe step is about half the time that sound takes
  /// through a voxel.
  bool jumps(const Poses& from, const Poses& to, double seconds, double step) const;
  void moved(const Poses& from, double seconds) { state_ = { from, seconds }; }

  const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }

private:
  double shortest_edge_;
  std::array<double, 3> far_corner_;
  State state_;
};

}  // namespace frontalis
