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

/// Bones that follow frames of tf2. A bone whose frame is missing, or whose latest transform is too old, stays where it
/// is; a bone whose frame jumps goes there at limited speed. Not thread-safe.
class BoneFollower
{
public:
  /// Starts to listen if there are frames. `speed`: limit of a bone's motion [m/s], where a turn counts as that of a
  /// point at 0.1 m; `patience`: age at which a transform is too old [s of ROS time].
  BoneFollower(std::vector<BoneFrame> frames, std::string face_frame, double speed, double patience);

  /// The motions of the bones in the face frame, for a call that comes `seconds` after the one before. Bones whose
  /// frame was never seen are left out.
  std::map<std::string, RigidTransform> follow(double seconds);
  /// All bones at rest again, as after a reset of the face.
  void clear();

  struct Status
  {
    std::string fault;        ///< why the bone stays where it is, or that it lags behind; empty if it follows
    std::uint64_t jumps = 0;  ///< of its frame
  };
  /// By bone.
  const std::map<std::string, Status>& status() const { return status_; }

private:
  /// The motion to which a bone's frame is now. Throws a tf2::TransformException or an Error if there is none.
  RigidTransform wanted(const BoneFrame& bone) const;

  const std::vector<BoneFrame> frames_;
  const std::string face_frame_;
  const double speed_, patience_;
  std::unique_ptr<tf2_ros::Buffer> buffer_;
  std::unique_ptr<tf2_ros::TransformListener> listener_;
  std::map<std::string, RigidTransform> motion_;
  std::map<std::string, Status> status_;
};

}  // namespace frontalis
