#!/usr/bin/python3
import rospy
from frontalis.msg import MuscleActivation
from geometry_msgs.msg import PoseArray

rospy.init_node("controller")
heights = []
rospy.Subscriber("face/landmarks", PoseArray, lambda message: heights.append(message.poses[0].position.z))
muscles = rospy.Publisher("face/muscle_activation", MuscleActivation, queue_size=1)
rate = rospy.Rate(30)
while not rospy.is_shutdown():
    command = MuscleActivation(name=["frontalis_left", "frontalis_right"], activation=[0.75, 0.75])
    command.header.stamp = rospy.Time.now()
    muscles.publish(command)
    if heights:
        rospy.loginfo_throttle(1, "the first landmark rose by %.1f mm" % (1e3 * (heights[-1] - heights[0])))
    rate.sleep()
