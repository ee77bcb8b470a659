#include "frontalis/ros/face_node.hpp"

#include <ros/ros.h>

int main(int count, char** arguments)
{
  ros::init(count, arguments, "face");
  frontalis::FaceNode face(ros::NodeHandle(), ros::NodeHandle("~"), ros::this_node::getName());

  // two threads, so that a long ~step does not delay the diagnostics
  ros::MultiThreadedSpinner spinner(2);
  spinner.spin();
  return 0;
}
