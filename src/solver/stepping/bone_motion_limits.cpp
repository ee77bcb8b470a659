#include "solver/stepping/bone_motion_limits.hpp"

#include "frontalis/solver/rigid_motion.hpp"
#include "solver/stepping/discretisation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace frontalis
{
namespace
{

constexpr double way_per_step = 0.1;  // longest path of a bone in a critical step, in shortest voxel edges
constexpr double way_per_plan = 0.5;  // longest path of a bone in a plan, in shortest voxel edges
// allowed jump of a bone's velocity, as path per step in shortest voxel edges
constexpr double velocity_jump_allowed = 0.005;
constexpr double straight_share = 1.0 / 64;  // fraction of a motion over which a bone's path is taken as straight

}  // namespace

double BoneMotionLimits::Reach::fastest_way(const RigidTransform& from, const RigidTransform& to) const
{
  std::array<double, 3> size{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    size[axis] = upper[axis] - lower[axis];
  const RigidTransform corner{ RigidTransform().rotation, lower };
  return size[0] >= 0 ? frontalis::fastest_way(composed(from, corner), composed(to, corner), size) : 0;
}

void BoneMotionLimits::Reach::include(const std::array<double, 3>& p)
{
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    lower[axis] = std::min(lower[axis], p[axis]);
    upper[axis] = std::max(upper[axis], p[axis]);
  }
}

BoneMotionLimits::BoneMotionLimits(const Model& model, double critical_step)
    : shortest_edge_(*std::min_element(model.spacing.begin(), model.spacing.end())),
      top_speed_(std::isfinite(critical_step) ? way_per_step * shortest_edge_ / critical_step : critical_step)
{
  constexpr double far = std::numeric_limits<double>::infinity();
  reach_.assign(model.bones.size(), { { { far, far, far } }, { { -far, -far, -far } } });
  each_point_on_bones(model, [&](std::int32_t bone, const std::array<double, 3>& p) { reach_[bone].include(p); });
}

BoneMotionLimits::Poses BoneMotionLimits::reached(const Poses& from, const Poses& to, double seconds) const
{
  Poses result = to;
  for (std::size_t b = 0; b < to.size(); ++b)
  {
    const double way = reach_[b].fastest_way(from[b], to[b]), longest = top_speed_ * seconds;
    if (way > longest)
      result[b] = interpolate(from[b], to[b], longest / way);
  }
  return result;
}

bool BoneMotionLimits::jumps(const Poses& from, const Poses& to, double seconds, double step) const
{
  const double time = (seconds_ > 0 ? std::min(seconds, seconds_) : seconds) * straight_share;
  double velocity = 0;  // [m/s]
  for (std::size_t b = 0; b < to.size() && time > 0; ++b)
  {
    const RigidTransform onwards = seconds_ > 0 ? interpolate(before_[b], from[b], 1 + time / seconds_) : from[b];
    const RigidTransform now = interpolate(from[b], to[b], time / seconds);
    velocity = std::max(velocity, reach_[b].fastest_way(onwards, now) / time);
  }
  return velocity / shortest_edge_ * step > velocity_jump_allowed;
}

double BoneMotionLimits::edges(const Poses& from, const Poses& to) const
{
  double farthest = 0;
  for (std::size_t b = 0; b < to.size(); ++b)
    if (from[b] != to[b])
      farthest = std::max(farthest, reach_[b].fastest_way(from[b], to[b]));
  return farthest / shortest_edge_;
}

double BoneMotionLimits::longest_plan(const Poses& from, const Poses& to, double seconds) const
{
  const double way = edges(from, to);
  return way > way_per_plan ? seconds * way_per_plan / way : std::numeric_limits<double>::infinity();
}

void BoneMotionLimits::moved(const Poses& from, double seconds)
{
  before_ = from;
  seconds_ = seconds;
}

}  // namespace frontalis
