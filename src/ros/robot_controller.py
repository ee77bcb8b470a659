#!/usr/bin/python3
"""Moves the joints of a robot face (doc/robots.md): trajectories in, joint states with efforts out.

It takes the place of a real robot's controller and has the topics of ros_control's joint trajectory controller. Joints follow a
trajectory at most as fast as the URDF allows. The effort of a joint is the force along its axis, or the torque about it, that
holds all links behind the joint against the skin. The skin's wrench on a link is ~wrench/LINK of the face.
"""

import threading
import xml.etree.ElementTree as xml

import rospy
import tf2_ros
from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

MOVING = ("prismatic", "revolute", "continuous")
LONGEST_WAIT = 60  # longest time until a trajectory begins [s]
STAMP_TOLERANCE = 1  # longest time since its end [s]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def turned(q, v):
    """A vector turned by a quaternion."""
    u = (q.x, q.y, q.z)
    once = cross(u, v)
    return [x + 2 * (q.w * y + z) for x, y, z in zip(v, once, cross(u, once))]


class Joint:
    def __init__(self, element):
        limit, axis = element.find("limit"), element.find("axis")
        self.name = element.get("name")
        self.child = element.find("child").get("link")
        # what is not given has URDF's default; a continuous joint has no bounds
        self.axis = [float(x) for x in (axis.get("xyz", "1 0 0") if axis is not None else "1 0 0").split()]
        self.turns = element.get("type") != "prismatic"
        given = {} if limit is None else limit.attrib
        bound = float("inf") if element.get("type") == "continuous" else 0.0
        self.lower, self.upper = float(given.get("lower", -bound)), float(given.get("upper", bound))
        self.velocity = float(given.get("velocity", "inf"))
        self.position = self.speed = 0.0
        self.efforts = {}  # by link behind the joint: what holds the link against the skin
        self.times, self.goals = [], []  # knots of the joint's trajectory; none: it stays

    def wanted(self, now):
        """The position of the trajectory at a time [s]."""
        for (t0, p0), (t1, p1) in zip(zip(self.times, self.goals), zip(self.times[1:], self.goals[1:])):
            if now <= t0:
                return p0
            if now < t1:
                return p0 + (p1 - p0) * (now - t0) / (t1 - t0)
        return self.goals[-1] if self.goals else self.position

    def move(self, now, seconds):
        farthest = self.velocity * seconds
        step = min(max(self.wanted(now) - self.position, -farthest), farthest)
        self.position += step
        self.speed = step / seconds


class Controller:
    def __init__(self):
        robot = xml.fromstring(rospy.get_param("robot_description"))
        self.joints = [Joint(joint) for joint in robot.findall("joint") if joint.get("type") in MOVING]
        self.by_name = {joint.name: joint for joint in self.joints}
        self.mutex = threading.Lock()
        self.states = rospy.Publisher("joint_states", JointState, queue_size=1)
        face = rospy.get_param("~face", "face")
        self.poses = {"neutral": {}, **rospy.get_param("~poses", {})}
        self.pose_time = rospy.Duration(rospy.get_param("~pose_time", 0.5))
        self.frames = tf2_ros.Buffer()
        self.listener = tf2_ros.TransformListener(self.frames)
        parents = {joint.find("child").get("link"): joint.find("parent").get("link") for joint in robot.findall("joint")}
        # the bone that follows a link, by default the one of the same name
        frames = rospy.get_param(face + "/bone_frames", {})
        bones = {frame["frame"] if isinstance(frame, dict) else frame: bone for bone, frame in frames.items()}
        for link in parents:
            behind, end = [], link
            while link:
                behind += [joint for joint in self.joints if joint.child == link]
                link = parents.get(link)
            for joint in behind:
                joint.efforts[end] = 0.0
            if behind:
                rospy.Subscriber("%s/wrench/%s" % (face, bones.get(end, end)), WrenchStamped, self.take_wrench, (end, behind), queue_size=1)
        rospy.Subscriber("~command", JointTrajectory, self.take_trajectory, queue_size=10)
        rospy.Subscriber("~pose", String, self.take_pose, queue_size=10)

    def take_wrench(self, message, target):
        """Keeps what each joint before a link must hold of the skin's wrench on the link."""
        link, joints = target
        force, torque = ((v.x, v.y, v.z) for v in (message.wrench.force, message.wrench.torque))
        for joint in joints:
            try:
                place = self.frames.lookup_transform(joint.child, message.header.frame_id, rospy.Time(0)).transform
            except tf2_ros.TransformException:
                continue  # frames of the face come with its first skin
            pull = turned(place.rotation, force)
            if joint.turns:
                arm = (place.translation.x, place.translation.y, place.translation.z)
                pull = [a + b for a, b in zip(turned(place.rotation, torque), cross(arm, pull))]
            joint.efforts[link] = -dot(joint.axis, pull)

    def fault(self, message):
        for name in message.joint_names:
            if name not in self.by_name:
                return "there is no joint '%s'; the joints are %s" % (name, ", ".join(self.by_name))
        if len(set(message.joint_names)) < len(message.joint_names):
            return "a joint is named twice"
        now = rospy.Time.now().to_sec()
        begin = message.header.stamp.to_sec() or now
        if begin > now + LONGEST_WAIT:
            return "it begins in %.3g s; allowed are %g s" % (begin - now, LONGEST_WAIT)
        if message.points and begin + message.points[-1].time_from_start.to_sec() < now - STAMP_TOLERANCE:
            return "it ended %.3g s ago" % (now - begin - message.points[-1].time_from_start.to_sec())
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

    def take_pose(self, message):
        if message.data not in self.poses:
            rospy.logwarn("there is no pose '%s'; the poses are %s" % (message.data, ", ".join(self.poses)))
            return
        goals = {**{name: 0.0 for name in self.by_name}, **self.poses[message.data]}
        point = JointTrajectoryPoint(positions=list(goals.values()), time_from_start=self.pose_time)
        self.take_trajectory(JointTrajectory(joint_names=list(goals), points=[point]))

    def play_demo(self, now):
        """Moves to the next pose every two seconds."""
        index = int(now / 2)
        if self.poses and index != self.demo_index:
            self.demo_index = index
            self.take_pose(String(sorted(self.poses)[index % len(self.poses)]))

    def run(self):
        demo, self.demo_index = rospy.get_param("~demo", False), -1
        rate = rospy.Rate(rospy.get_param("~rate", 50), reset=True)
        before = rospy.Time.now()
        while not rospy.is_shutdown():
            now = rospy.Time.now()
            with self.mutex:
                if now > before:
                    for joint in self.joints:
                        joint.move(now.to_sec(), (now - before).to_sec())
                elif now < before:  # a bag or a simulator has begun again: trajectories have times of before
                    for joint in self.joints:
                        joint.times, joint.goals, joint.speed = [], [], 0.0
                before = now
                message = JointState(
                    name=[joint.name for joint in self.joints],
                    position=[joint.position for joint in self.joints],
                    velocity=[joint.speed for joint in self.joints],
                    effort=[sum(joint.efforts.values()) for joint in self.joints],
                )
            message.header.stamp = now
            self.states.publish(message)
            if demo:
                self.play_demo(now.to_sec())
            try:
                rate.sleep()
            except rospy.ROSInterruptException:
                return


if __name__ == "__main__":
    rospy.init_node("robot_controller")
    Controller().run()
