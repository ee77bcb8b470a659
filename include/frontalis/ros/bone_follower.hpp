#pragma once

#include "frontalis/ros/parameters.hpp"

#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace frontalis
{

/// Moves bones with frames of tf2. A bone whose frame is missing, or whose latest transform is too old, stays where it
/// is. A bone whose frame jumps moves to the frame's new pose at limited speed. Not thread-safe.
class BoneFollower
{
public:
  /// Listens to tf2 if there are frames. `speed`: greatest speed of a bone [m/s]; a rotation counts as the motion of
  /// points 0.1 m from the origin.
  BoneFollower(std::vector<BoneFrame> frames, std::string face_frame, double speed);

  /// The motions in the face frame of the bones whose frames were ever seen. `seconds`: time since the previous call.
  /// `patience`: greatest age of a transform [s of ROS time].
  std::map<std::string, RigidTransform> follow(double seconds, double patience);
  /// Returns all bones to rest, as a reset of the face requires.
  void clear();

  struct Status
  {
    std::string fault;        ///< why the bone stays where it is, or that it lags behind; empty if it follows
    std::uint64_t jumps = 0;  ///< number of jumps of the bone's frame
  };
  /// The status of each bone, by name.
  const std::map<std::string, Status>& status() const { return status_; }

private:
  /// The motion that puts the bone at its frame's present pose. Throws a tf2::TransformException or an Error if the
  /// transform is missing or too old.
  RigidTransform wanted(const BoneFrame& bone, double patience) const;

  const std::vector<BoneFrame> frames_;
  const std::string face_frame_;
  const double speed_;
  std::unique_ptr<tf2_ros::Buffer> buffer_;
  std::unique_ptr<tf2_ros::TransformListener> listener_;
  std::map<std::string, RigidTransform> motion_;
  std::map<std::string, Status> status_;
};

}  // namespace frontalis
