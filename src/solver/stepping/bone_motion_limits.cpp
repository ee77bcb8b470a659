#include "solver/stepping/bone_motion_limits.hpp"

#include "frontalis/solver/rigid_motion.hpp"
#include "solver/stepping/discretisation.hpp"

#include <algorithm>
#include <limits>

namespace frontalis
{
namespace
{

constexpr double way_per_step = 0.1;  // longest path of a bone in a step, in shortest voxel edges
// allowed jump of a bone's velocity, as path per step in shortest voxel edges
constexpr double velocity_jump_allowed = 0.005;
constexpr double straight_share = 1.0 / 64;  // fraction of a motion over which a bone's path is taken as straight

}  // namespace

BoneMotionLimits::BoneMotionLimits(const Model& model)
    : shortest_edge_(*std::min_element(model.spacing.begin(), model.spacing.end())), far_corner_(far_corner(model))
{
}

double BoneMotionLimits::longest_step(const Poses& from, const Poses& to, double seconds) const
{
  double fastest = 0;
  for (std::size_t b = 0; b < to.size(); ++b)
    fastest = std::max(fastest, fastest_way(from[b], to[b], far_corner_));
  return fastest > 0 ? way_per_step * shortest_edge_ * seconds / fastest : std::numeric_limits<double>::infinity();
}

bool BoneMotionLimits::jumps(const Poses& from, const Poses& to, double seconds, double step) const
{
  const double time = (seconds_ > 0 ? std::min(seconds, seconds_) : seconds) * straight_share;
  double velocity = 0;  // [m/s]
  for (std::size_t b = 0; b < to.size() && time > 0; ++b)
  {
    const RigidTransform onwards = seconds_ > 0 ? interpolate(before_[b], from[b], 1 + time / seconds_) : from[b];
    const RigidTransform now = interpolate(from[b], to[b], time / seconds);
    velocity = std::max(velocity, farthest_way(onwards, now, far_corner_) / time);
  }
  return velocity / shortest_edge_ * step > velocity_jump_allowed;
}

void BoneMotionLimits::moved(const Poses& from, double seconds)
{
  before_ = from;
  seconds_ = seconds;
}

}  // namespace frontalis
