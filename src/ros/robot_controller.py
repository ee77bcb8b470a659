#!/usr/bin/python3
"""Moves the joints of a robot face (doc/robots.md): trajectories in, joint states with efforts out.

It takes the place of a real robot's controller and has the topics of ros_control's joint trajectory controller. Joints follow a
trajectory at most as fast as the URDF allows. The effort of a joint is the force or torque that its anchor needs against the skin,
along the joint's axis: the opposite of ~wrench/ANCHOR of the face.
"""

import threading
import xml.etree.ElementTree as xml

import rospy
from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory

MOVING = ("prismatic", "revolute", "continuous")


class Joint:
    def __init__(self, element):
        limit = element.find("limit")
        self.name = element.get("name")
        self.child = element.find("child").get("link")
        self.axis = [float(x) for x in element.find("axis").get("xyz").split()]
        self.turns = element.get("type") != "prismatic"
        self.lower, self.upper, self.velocity = (float(limit.get(key)) for key in ("lower", "upper", "velocity"))
        self.position = self.speed = self.effort = 0.0
        self.times, self.goals = [], []  # knots of the joint's trajectory; none: it stays

    def wanted(self, now):
        """The position of the trajectory at a time [s]."""
        for (t0, p0), (t1, p1) in zip(zip(self.times, self.goals), zip(self.times[1:], self.goals[1:])):
            if now < t1:
                return p0 + (p1 - p0) * max(0.0, now - t0) / (t1 - t0)
        return self.goals[-1] if self.goals else self.position

    def move(self, now, seconds):
        farthest = self.velocity * seconds
        step = min(max(self.wanted(now) - self.position, -farthest), farthest)
        self.position += step
        self.speed = step / seconds


class Controller:
    def __init__(self):
        robot = xml.fromstring(rospy.get_param("robot_description"))
        self.joints = [Joint(joint) for joint in robot.iter("joint") if joint.get("type") in MOVING]
        self.by_name = {joint.name: joint for joint in self.joints}
        # the anchor of a joint is the link at the end of its chain
        next_link = {joint.find("parent").get("link"): joint.find("child").get("link") for joint in robot.iter("joint")}
        self.mutex = threading.Lock()
        self.states = rospy.Publisher("joint_states", JointState, queue_size=1)
        face = rospy.get_param("~face", "face")
        for joint in self.joints:
            anchor = joint.child
            while anchor in next_link:
                anchor = next_link[anchor]
            rospy.Subscriber("%s/wrench/%s" % (face, anchor), WrenchStamped, self.take_wrench, joint, queue_size=1)
        rospy.Subscriber("~command", JointTrajectory, self.take_trajectory, queue_size=10)

    def take_wrench(self, message, joint):
        # the anchor's frame is parallel to the face frame and the joints' frames
        vector = message.wrench.torque if joint.turns else message.wrench.force
        joint.effort = -sum(a * b for a, b in zip(joint.axis, (vector.x, vector.y, vector.z)))

    def fault(self, message):
        for name in message.joint_names:
            if name not in self.by_name:
                return "there is no joint '%s'; the joints are %s" % (name, ", ".join(self.by_name))
        before = -1.0
        for point in message.points:
            time = point.time_from_start.to_sec()
            if time <= before:
                return "times must ascend from 0"
            before = time
            if len(point.positions) != len(message.joint_names):
                return "a point has %d positions; must have %d" % (len(point.positions), len(message.joint_names))
            for name, position in zip(message.joint_names, point.positions):
                joint = self.by_name[name]
                if not joint.lower <= position <= joint.upper:
                    return "%s: found %g; must be from %g to %g" % (name, position, joint.lower, joint.upper)
        return None

    def take_trajectory(self, message):
        fault = self.fault(message)
        if fault:
            rospy.logwarn("trajectory refused: " + fault)
            return
        with self.mutex:
            stamp = message.header.stamp
            begin = (stamp if stamp else rospy.Time.now()).to_sec()
            for index, name in enumerate(message.joint_names):
                joint = self.by_name[name]
                joint.times = [begin] + [begin + point.time_from_start.to_sec() for point in message.points]
                joint.goals = [joint.position] + [point.positions[index] for point in message.points]

    def run(self):
        rate = rospy.Rate(rospy.get_param("~rate", 50))
        before = rospy.Time.now()
        while not rospy.is_shutdown():
            now = rospy.Time.now()
            with self.mutex:
                if now > before:
                    for joint in self.joints:
                        joint.move(now.to_sec(), (now - before).to_sec())
                before = now
                message = JointState(
                    name=[joint.name for joint in self.joints],
                    position=[joint.position for joint in self.joints],
                    velocity=[joint.speed for joint in self.joints],
                    effort=[joint.effort for joint in self.joints],
                )
            message.header.stamp = now
            self.states.publish(message)
            try:
                rate.sleep()
            except rospy.ROSInterruptException:
                return


if __name__ == "__main__":
    rospy.init_node("robot_controller")
    Controller().run()
