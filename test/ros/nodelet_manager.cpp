#include <ros/ros.h>

#include <nodelet/loader.h>

// The nodelet manager of test/sanitized: nodelets can be instrumented only in a program that is instrumented too, and
// ROS's manager is not.
int main(int count, char** arguments)
{
  ros::init(count, arguments, "manager");
  const nodelet::Loader loader;
  ros::spin();
  return 0;
}
