#!/usr/bin/python3
import rospy
from frontalis.msg import MuscleActivation
from geometry_msgs.msg import PoseArray

rospy.init_node("controller")
muscles = rospy.Publisher("face/muscle_activation", MuscleActivation, queue_size=1)
rest = rospy.wait_for_message("face/landmarks", PoseArray).poses[0].position.z
rate = rospy.Rate(30)
while not rospy.is_shutdown():
    command = MuscleActivation(name=["frontalis_left", "frontalis_right"], activation=[0.75, 0.75])
    command.header.stamp = rospy.Time.now()
    muscles.publish(command)
    rise = rospy.wait_for_message("face/landmarks", PoseArray).poses[0].position.z - rest
    rospy.loginfo_throttle(1, "the first landmark rose by %.1f mm" % (1e3 * rise))
    rate.sleep()
