#!/usr/bin/python3
"""A bone that a topic moves: the tissue on it follows, and bad poses are refused."""

import math
import unittest

import rospy
import rostest
from geometry_msgs.msg import Quaternion, TransformStamped, Vector3

from face import Face, wait


def pose(shift=(0, 0, 0), turn=(0, 0, 0, 1), bone="skull"):
    message = TransformStamped()
    message.header.stamp = rospy.Time.now()
    message.child_frame_id = bone
    message.transform.translation = Vector3(*shift)
    message.transform.rotation = Quaternion(*turn)
    return message


class Moved(unittest.TestCase):
    def setUp(self):
        self.face = Face()
        self.face.wait_until_ready(60)
        self.poses = rospy.Publisher("/face/bone_pose", TransformStamped, queue_size=20)
        wait(self.poses.get_num_connections, "the face's ear for bones", 30)
        self.assertTrue(self.face.reset().success)
        wait(lambda: self.face.state.time == 0, "the reset", 10)
        # the landmarks of the reset may come after its state
        wait(lambda: abs(self.tip()[2] + 0.01) < 1e-6, "the tip at rest", 10)
        self.rest = self.tip()

    def tip(self):
        at = self.face.landmarks.poses[self.face.state.landmark.index("tip")].position
        return (at.x, at.y, at.z)

    def step(self, seconds):
        answer = self.face.step(seconds)
        self.assertTrue(answer.success, answer.message)
        wait(lambda: abs(self.face.state.time - answer.time) < 1e-9, "the state", 10)
        rospy.sleep(0.2)

    def send(self, *messages):
        for message in messages:
            self.poses.publish(message)
        rospy.sleep(0.5)

    def test_tissue_follows_its_bone(self):
        self.send(pose((0.002, 0, 0.005)))
        self.step(0.5)
        for now, before, moved in zip(self.tip(), self.rest, (0.002, 0, 0.005)):
            self.assertAlmostEqual(now - before, moved, 4)

    def test_bone_that_jumps_is_no_danger(self):
        for shift in (0.005, -0.005, 0.005, 0):
            self.send(pose((shift, 0, 0)))
            self.step(0.05)
        self.step(1.0)
        self.assertFalse(self.face.state.failed)
        for now, before in zip(self.tip(), self.rest):
            self.assertAlmostEqual(now, before, 3)

    def test_turned_bone_turns_its_tissue(self):
        half = math.sin(math.pi / 4)
        self.send(pose(turn=(0, 0, half, half)))
        self.step(1.0)
        self.assertAlmostEqual(self.tip()[0], -self.rest[1], 3)
        self.assertAlmostEqual(self.tip()[1], self.rest[0], 3)

    def test_bad_poses_are_refused(self):
        self.send(
            pose((math.nan, 0, 0)), pose((0, math.inf, 0)), pose((0, 0, -math.inf)), pose(turn=(math.nan, 0, 0, 1)),
            pose(turn=(math.inf, 0, 0, 1)), pose(turn=(0, 0, 0, 0)), pose(turn=(0, 0, 0.5, 1)),
            pose((0.01, 0, 0), bone="mandible"), pose((0.01, 0, 0), bone=""))
        self.step(0.3)
        self.assertFalse(self.face.state.failed)
        for now, before in zip(self.tip(), self.rest):
            self.assertAlmostEqual(now, before, 6)
        # and it still listens
        self.send(pose((0, 0, 0.003)))
        self.step(0.5)
        self.assertAlmostEqual(self.tip()[2] - self.rest[2], 0.003, 4)


if __name__ == "__main__":
    rospy.init_node("moved_test")
    rostest.rosrun("frontalis", "moved", Moved)
