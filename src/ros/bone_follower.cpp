#include "frontalis/ros/bone_follower.hpp"

#include "frontalis/error.hpp"
#include "frontalis/ros/conversions.hpp"
#include "frontalis/solver/rigid_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace frontalis
{

BoneFollower::BoneFollower(std::vector<BoneFrame> frames, std::string face_frame, double speed)
    : frames_(std::move(frames)), face_frame_(std::move(face_frame)), speed_(speed)
{
  if (frames_.empty())
    return;
  buffer_ = std::make_unique<tf2_ros::Buffer>();
  listener_ = std::make_unique<tf2_ros::TransformListener>(*buffer_);
}

void BoneFollower::clear()
{
  motion_.clear();
  status_.clear();
}

RigidTransform BoneFollower::wanted(const BoneFrame& bone, double patience) const
{
  // time 0 means the latest time that all links have in common, so that nothing is extrapolated
  const auto place = [&](const std::string& frame)
  { return buffer_->lookupTransform(face_frame_, frame, ros::Time(0)); };
  const auto now = place(bone.frame);
  // A static transform has the stamp 0 and is never too old.
  const double age = now.header.stamp.isZero() ? 0.0 : (ros::Time::now() - now.header.stamp).toSec();
  if (std::abs(age) > patience)
    throw Error(fmt::format("the latest transform of '{}' is {:.3g} s {}; allowed are {:.3g} s", bone.frame,
                            std::abs(age), age > 0 ? "old" : "in the future", patience));
  const RigidTransform motion = to_motion(now.transform);
  return bone.rest.empty() ? motion : composed(motion, inverse(to_motion(place(bone.rest).transform)));
}

std::map<std::string, RigidTransform> BoneFollower::follow(double seconds, double patience)
{
  for (const BoneFrame& bone : frames_)
  {
    Status& status = status_[bone.bone];
    try
    {
      const RigidTransform target = wanted(bone, patience);
      if (!is_rigid_motion(target))
        throw Error("the transform of '" + bone.frame + "' is not finite");
      RigidTransform& at = motion_[bone.bone];
      const double way = farthest_way(at, target, { { 0.1, 0.1, 0.1 } });
      const double allowed = speed_ * seconds;
      const bool behind = way > allowed;
      if (behind && status.fault.empty())
        ++status.jumps;
      at = behind ? interpolate(at, target, allowed / way) : target;
      status.fault = behind ? fmt::format("'{}' jumped by {:.3g} mm; the bone follows at {:.3g} m/s", bone.frame,
                                          1e3 * way, speed_)
                            : "";
    }
    catch (const std::exception& error)
    {
      status.fault = error.what();
    }
  }
  return motion_;
}

}  // namespace frontalis
