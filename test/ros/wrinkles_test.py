#!/usr/bin/python3
"""Measured wrinkles: those of the frame that was published last, in the part of the skin that the node was asked for."""

import unittest

import rospy
import rostest
from frontalis.msg import SkinWrinkles

from face import Face, wait


class Wrinkles(unittest.TestCase):
    def setUp(self):
        self.face = Face()
        self.latest = None

    def take(self, message):
        self.latest = message

    def wrinkles(self):
        """The wrinkles of the latest frame."""
        wait(lambda: self.latest is not None and self.latest.header.stamp == self.face.landmarks.header.stamp, "wrinkles of the frame")
        return self.latest

    def test_are_published(self):
        self.face.wait_until_ready()
        subscriber = rospy.Subscriber("/face/wrinkles", SkinWrinkles, self.take)
        wait(subscriber.get_num_connections, "a connection")
        self.assertTrue(self.face.step(0.01).success)
        flat = self.wrinkles()
        self.assertEqual((flat.count, flat.depth, len(flat.line)), (0, 0, 0))

        self.face.command(slab=1)
        wait(lambda: self.face.step(0.2).success and self.face.state.activation == (1.0,), "the activation")
        for _ in range(3):
            self.assertTrue(self.face.step(0.2).success)
        folded = self.wrinkles()
        self.assertEqual(folded.header.frame_id, self.face.landmarks.header.frame_id)
        self.assertGreater(abs(folded.direction.y), 0.99)
        self.assertGreater(folded.depth, 0.3e-3)
        self.assertGreaterEqual(folded.deepest, folded.depth)
        self.assertGreater(folded.spacing, 8e-3)
        self.assertLess(folded.spacing, 15e-3)
        self.assertEqual(len(folded.line), len(folded.line_depth))
        self.assertEqual(len(folded.line), len(folded.line_length))
        self.assertGreaterEqual(len(folded.line), 2)
        self.assertLess(max(folded.line_length), 55e-3)  # the part is 40 mm wide at rest, the slab 60 mm, and it becomes wider
        for middle in folded.line:
            self.assertLess(abs(middle.y), 0.02)


if __name__ == "__main__":
    rospy.init_node("wrinkles_test")
    rostest.rosrun("frontalis", "wrinkles", Wrinkles)
