#!/usr/bin/python3
"""A bone follows a frame of tf2, and reacts as documented if the frame is missing, jumps, or is out of date."""

import math
import unittest

import rospy
import rostest
import tf2_ros
from geometry_msgs.msg import Quaternion, TransformStamped, Vector3

from face import Face, wait

REST = (-0.05, 0.01, 0.02)  # position of the followed frame at rest, in the face frame [m]


def link(parent, child, shift, age=0, turn=(0, 0, 0, 1)):
    message = TransformStamped(child_frame_id=child)
    message.header.frame_id = parent
    message.header.stamp = rospy.Time.now() - rospy.Duration(age)
    message.transform.translation = Vector3(*shift)
    message.transform.rotation = Quaternion(*turn)
    return message


class Follow(unittest.TestCase):
    def setUp(self):
        self.face = Face()
        self.face.wait_until_ready()
        self.frames = tf2_ros.TransformBroadcaster()
        self.fixed = tf2_ros.StaticTransformBroadcaster()
        wait(self.frames.pub_tf.get_num_connections, "a listener")

    def wait_for_word(self, word, **shown):
        """Steps and sends the frame until the diagnostics contain the word."""

        def told():
            self.show(**shown)
            self.face.advance(0.01)
            return any(word in status.message for status in self.face.diagnostics)

        wait(told, "the word '%s'" % word)

    def show(self, shift=None, age=0, turn=(0, 0, 0, 1)):
        if shift is not None:
            self.frames.sendTransform(link("face", "jaw", [r + s for r, s in zip(REST, shift)], age, turn))

    def step_until_tip_at(self, place, shift, **shown):
        def arrived():
            self.show(shift, **shown)
            self.face.advance(0.2)
            return max(abs(now - wanted) for now, wanted in zip(self.face.place("tip"), place)) < 2e-4

        wait(arrived, "the tip at its place")

    def test_follows_and_tells_of_faults(self):
        rest = self.face.place("tip")
        # in lock-step a face moves in ~step alone
        self.assertTrue(self.face.state.paused)
        self.assertIn("lock_step", self.face.pause(False).message)
        # without a frame the bone stays where it is, and the diagnostics name the reason
        self.wait_for_word("jaw")
        self.assertAlmostEqual(self.face.place("tip")[2], rest[2], 5)
        self.assertEqual(self.face.diagnostics[0].level, 1)
        # the frame is first at its place of rest, then 3 mm above it
        self.fixed.sendTransform(link("face", "jaw_rest", REST))
        self.step_until_tip_at(rest, (0, 0, 0))
        self.step_until_tip_at((rest[0], rest[1], rest[2] + 0.003), (0, 0, 0.003))
        wait(lambda: self.face.diagnostics[0].level == 0, "good diagnostics")
        # ~bone_pose cannot move a bone that follows a frame
        poses = rospy.Publisher("/face/bone_pose", TransformStamped, queue_size=1)
        wait(poses.get_num_connections, "a connection")
        poses.publish(link("face", "skull", (0.01, 0, 0)))
        wait(lambda: "follows" in (self.face.diagnostic("latest refusal on ~bone_pose") or ""), "a refusal")
        # a frame that jumps by 40 mm is followed at 0.1 m/s
        self.wait_for_word("jumped", shift=(0.04, 0, 0))
        self.assertLess(self.face.place("tip")[0], rest[0] + 0.03)
        self.step_until_tip_at((rest[0] + 0.04, rest[1], rest[2]), (0.04, 0, 0))
        self.assertFalse(self.face.state.failed)
        # the bone turns about the origin of the frame
        half = math.radians(5)
        turned = (0, math.sin(half), 0, math.cos(half))
        x, z = rest[0] - REST[0], rest[2] - REST[2]
        place = (REST[0] + x * math.cos(2 * half) + z * math.sin(2 * half), rest[1],
                 REST[2] - x * math.sin(2 * half) + z * math.cos(2 * half))
        self.step_until_tip_at(place, (0, 0, 0), turn=turned)
        # a transform with a stamp that is too old or in the future is not used
        self.wait_for_word("in the future", shift=(0, 0, 0), age=-2000)
        self.assertLess(max(abs(a - b) for a, b in zip(self.face.place("tip"), place)), 2e-4)


if __name__ == "__main__":
    rospy.init_node("follow_test")
    rostest.rosrun("frontalis", "follow", Follow)
