#!/usr/bin/python3
"""The wrench, frame and marker of a finger that the demo presses on tissue."""

import json
import math
import os
import subprocess
import tempfile
import unittest

import roslib.packages
import rospkg
import rospy
import rostest
import tf2_ros
from geometry_msgs.msg import TransformStamped, WrenchStamped
from visualization_msgs.msg import MarkerArray

from face import Face, wait

CENTRE = (0.001, 0, -0.0182)  # centre of the finger at rest, face frame [m]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def turned(q, v):
    """A vector turned by a quaternion."""
    axis = (q.x, q.y, q.z)
    t = [2 * c for c in cross(axis, v)]
    return [v[i] + q.w * t[i] + cross(axis, t)[i] for i in range(3)]


def triple(message):
    return [message.x, message.y, message.z]


class Touch(unittest.TestCase):
    def setUp(self):
        self.face = Face()
        self.face.wait_until_ready()
        self.frames = tf2_ros.Buffer()
        self.listener = tf2_ros.TransformListener(self.frames)
        self.wrench = None
        self.subscriber = rospy.Subscriber("/face/wrench/press", WrenchStamped, self.take)
        wait(lambda: self.subscriber.get_num_connections() > 0, "the connection for wrenches")

    def take(self, message):
        self.wrench = message

    def press(self, seconds):
        """Steps, and waits for the wrench and the frame of the same time."""
        self.face.advance(seconds)
        wait(lambda: self.wrench is not None and self.wrench.header.stamp >= self.face.state.header.stamp, "the wrench")
        wrench = self.wrench
        self.assertEqual(wrench.header.frame_id, "face/body/press")
        wait(lambda: self.frames.can_transform("face", "face/body/press", wrench.header.stamp), "the frame of the finger")
        return wrench.wrench, self.frames.lookup_transform("face", "face/body/press", wrench.header.stamp).transform

    def run_program(self):
        """Returns force and moment of the same motion by `frontalis run`, about the face frame's origin as the finger carries it."""
        with tempfile.TemporaryDirectory() as folder:
            scene = os.path.join(rospkg.RosPack().get_path("frontalis"), "test/ros/touch.yaml")
            program = roslib.packages.find_node("frontalis", "frontalis")[0]
            subprocess.run(
                [program, "run", scene, "--backend", "cpu", "--threads", "1", "--bone", "finger=0,0,1.2,0,5,0", "--ramp", "0.1",
                 "--seconds", "0.6", "--frames", folder], check=True, stdout=subprocess.DEVNULL)
            with open(os.path.join(folder, "run.json"), encoding="utf-8") as text:
                reaction = json.load(text)["reactions"]["press"]
        return reaction["force_N"], reaction["moment_Nm"]

    def test_wrench_is_that_of_a_run(self):
        self.assertTrue(self.face.reset().success)
        # a step goes to the pose at its end, so step through the ramp of the demo first
        self.press(0.1)
        wrench, frame = self.press(0.5)
        force, moment = self.run_program()
        self.assertLess(force[2], 0)
        self.assertGreater(math.hypot(*force), 0.05)
        for got, expected in zip(turned(frame.rotation, triple(wrench.force)), force):
            self.assertAlmostEqual(got, expected, delta=1e-3 * math.hypot(*force))
        # transfer the torque from the finger's centre to the face frame's origin as the finger carries it
        arm = turned(frame.rotation, CENTRE)
        about = [m + c for m, c in zip(turned(frame.rotation, triple(wrench.torque)), cross(arm, force))]
        for got, expected in zip(about, moment):
            self.assertAlmostEqual(got, expected, delta=1e-3 * math.hypot(*force) * 0.02)
        # the finger is a ball, so only friction has a moment about its centre
        self.assertLess(math.hypot(*triple(wrench.torque)), 0.25 * 0.008 * math.hypot(*force))
        # the finger has the pose of the demo: turned by 5 degrees about y, and lifted
        at = triple(frame.translation)
        sine, cosine = math.sin(math.radians(5)), math.cos(math.radians(5))
        self.assertAlmostEqual(at[0], cosine * CENTRE[0] + sine * CENTRE[2], 6)
        self.assertAlmostEqual(at[2], -sine * CENTRE[0] + cosine * CENTRE[2] + 0.0012, 6)

    def test_finger_is_shown(self):
        marker = rospy.wait_for_message("/face/bodies", MarkerArray, 60).markers[0]
        self.assertEqual(marker.header.frame_id, "face/body/press")
        self.assertTrue(marker.frame_locked)
        self.assertGreater(len(marker.points), 300)
        for p in marker.points:
            self.assertAlmostEqual(math.hypot(p.x, p.y, p.z), 0.008, delta=1e-3)

    def test_pose_ends_the_demo(self):
        self.assertTrue(self.face.reset().success)
        poses = rospy.Publisher("/face/bone_pose", TransformStamped, queue_size=1)
        wait(poses.get_num_connections, "the connection for poses")
        message = TransformStamped(child_frame_id="finger")
        message.transform.rotation.w = 1

        # a pose in another frame is refused
        message.header.frame_id = "map"
        poses.publish(message)
        wait(lambda: "'map'" in (self.face.diagnostic("latest refusal on ~bone_pose") or ""), "the refusal")
        message.header.frame_id = "face"

        def parted():
            poses.publish(message)
            wrench, frame = self.press(0.2)
            return triple(wrench.force) == [0, 0, 0] and abs(frame.translation.z - CENTRE[2]) < 1e-6

        wait(parted, "the finger back at rest")


if __name__ == "__main__":
    rospy.init_node("touch_test")
    rostest.rosrun("frontalis", "touch", Touch)
