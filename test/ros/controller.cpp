#include <frontalis/MuscleActivation.h>
#include <ros/ros.h>

int main(int count, char** arguments)
{
  ros::init(count, arguments, "controller");
  ros::NodeHandle node;
  ros::Publisher muscles = node.advertise<frontalis::MuscleActivation>("face/muscle_activation", 1);
  for (ros::Rate rate(30); ros::ok(); rate.sleep())
  {
    frontalis::MuscleActivation command;
    command.header.stamp = ros::Time::now();
    command.name = { "frontalis_left", "frontalis_right" };
    command.activation = { 0.75, 0.75 };
    muscles.publish(command);
  }
}
