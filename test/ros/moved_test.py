#!/usr/bin/python3
"""A bone that a topic moves: the tissue on the bone follows, and bad poses are refused."""

import math
import unittest

import rospy
import rostest
from geometry_msgs.msg import Quaternion, TransformStamped, Vector3

from face import Face, wait


def pose(shift=(0, 0, 0), turn=(0, 0, 0, 1), bone="skull"):
    message = TransformStamped()
    message.child_frame_id = bone
    message.transform.translation = Vector3(*shift)
    message.transform.rotation = Quaternion(*turn)
    return message


class Moved(unittest.TestCase):
    def setUp(self):
        self.face = Face()
        self.face.wait_until_ready()
        self.poses = rospy.Publisher("/face/bone_pose", TransformStamped, queue_size=20)
        wait(self.poses.get_num_connections, "the connection for poses")
        self.assertTrue(self.face.reset().success)
        self.face.wait_for_frame(lambda: self.face.state.time == 0, "the reset")
        self.assertAlmostEqual(self.face.place("tip")[2], -0.01, 6)
        self.rest = self.face.place("tip")

    def send(self, *messages):
        before = self.face.list_muscles().messages
        for message in messages:
            self.poses.publish(message)
        wait(lambda: self.face.list_muscles().messages == before + len(messages), "the poses")

    def step_until_tip_at(self, place, within):
        """Steps until the tip rests at a place [m]. It takes more than one step if a pose arrives late."""

        def arrived():
            self.face.advance(0.5)
            return max(abs(now - wanted) for now, wanted in zip(self.face.place("tip"), place)) < within

        wait(arrived, "the tip at its place")

    def test_tissue_follows_its_bone(self):
        self.send(pose((0.002, 0, 0.005)))
        self.step_until_tip_at((self.rest[0] + 0.002, self.rest[1], self.rest[2] + 0.005), 5e-5)

    def test_bone_that_jumps_is_no_danger(self):
        for shift in (0.005, -0.005, 0.005, 0):
            self.send(pose((shift, 0, 0)))
            self.face.advance(0.05)
        self.step_until_tip_at(self.rest, 5e-4)
        self.assertFalse(self.face.state.failed)

    def test_turned_bone_turns_its_tissue(self):
        half = math.sin(math.pi / 4)
        self.send(pose(turn=(half, 0, 0, half)))
        # a quarter turn about x takes -z to y
        self.step_until_tip_at((self.rest[0], -self.rest[2], self.rest[1]), 5e-4)

    def test_bad_poses_are_refused(self):
        self.send(
            pose((math.nan, 0, 0)), pose((0, math.inf, 0)), pose((0, 0, -math.inf)), pose(turn=(math.nan, 0, 0, 1)),
            pose(turn=(math.inf, 0, 0, 1)), pose(turn=(0, 0, 0, 0)), pose(turn=(0, 0, 0.5, 1)),
            pose((0.01, 0, 0), bone="mandible"), pose((0.01, 0, 0), bone=""))
        self.face.advance(0.3)
        self.assertFalse(self.face.state.failed)
        for now, before in zip(self.face.place("tip"), self.rest):
            self.assertAlmostEqual(now, before, 6)
        # after bad messages, good ones are still accepted
        self.send(pose((0, 0, 0.003)))
        self.step_until_tip_at((self.rest[0], self.rest[1], self.rest[2] + 0.003), 5e-5)


if __name__ == "__main__":
    rospy.init_node("moved_test")
    rostest.rosrun("frontalis", "moved", Moved)
