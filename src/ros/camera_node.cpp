#include "frontalis/ros/virtual_camera.hpp"

#include <ros/ros.h>

#include <exception>

int main(int count, char** arguments)
{
  ros::init(count, arguments, "camera");
  const ros::NodeHandle handle;  // logging ends with the last handle, so it is kept until the error is logged
  try
  {
    const frontalis::VirtualCamera camera(handle, ros::NodeHandle("~"));
    ros::spin();
    return 0;
  }
  catch (const std::exception& error)
  {
    ROS_FATAL("%s", error.what());
    return 1;
  }
}
