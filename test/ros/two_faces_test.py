#!/usr/bin/python3
"""Two faces in one nodelet manager: each has its own topics, services and frames."""

import unittest

import rospy
import rostest
import tf2_ros

from face import LIMIT, Face, wait


class TwoFaces(unittest.TestCase):
    def test_do_not_disturb_each_other(self):
        left, right = Face("/left/face"), Face("/right/face")
        for face in (left, right):
            face.wait_until_ready()
        self.assertEqual(left.state.header.frame_id, "face_left")
        self.assertEqual(right.state.header.frame_id, "face_right")
        left.express("wink")
        right.command(lift=0.3)
        wait(lambda: abs(left.state.activation[0] - 0.6) < 1e-3, "the left face")
        wait(lambda: abs(right.state.activation[0] - 0.3) < 1e-3, "the right face")
        self.assertTrue(left.reset().success)
        wait(lambda: max(left.state.activation) < 1e-3, "the reset of the left face")
        self.assertAlmostEqual(right.state.activation[0], 0.3, 2)
        frames = tf2_ros.Buffer()
        listener = tf2_ros.TransformListener(frames)
        for name in ("left", "right"):
            frames.lookup_transform("map", "face_%s/tip" % name, rospy.Time(0), rospy.Duration(LIMIT))
        listener.unregister()


if __name__ == "__main__":
    rospy.init_node("two_faces_test")
    rostest.rosrun("frontalis", "two_faces", TwoFaces)
