#pragma once

#include <ros/time.h>

namespace frontalis
{

/// Limits how often something is logged, by the wall clock: ROS's own throttled messages follow the ROS clock, which
/// may stand still or not have begun.
class WallThrottle
{
public:
  /// Returns true at most once per `period` [s].
  bool passes(double period)
  {
    const ros::WallTime now = ros::WallTime::now();
    if (now < next_)
      return false;
    next_ = now + ros::WallDuration(period);
    return true;
  }

private:
  ros::WallTime next_;
};

}  // namespace frontalis
