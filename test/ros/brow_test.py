#!/usr/bin/python3
"""Raises the brows of the generated forehead in real time; the landmarks show that they go up and come back."""

import math
import unittest

import rospy
import rostest

from face import Face, wait

BROWS = ("brow_left", "brow_right")


class Brow(unittest.TestCase):
    def test_goes_up_by_millimetres_and_comes_back(self):
        face = Face()
        face.wait_until_ready()
        self.assertEqual(face.state.header.frame_id, "face")
        rest = {name: face.height(name) for name in BROWS}

        face.command(frontalis_left=0.75, frontalis_right=0.75)
        wait(lambda: all(face.height(name) - rest[name] > 2e-3 for name in BROWS), "both brows 2 mm up")
        self.settle(face)
        up = {name: face.height(name) - rest[name] for name in BROWS}
        for name in BROWS:
            self.assertGreater(up[name], 2e-3)
            self.assertLess(up[name], 20e-3)
        self.assertLess(abs(up["brow_left"] - up["brow_right"]), 1e-3, "the forehead is symmetric")

        face.command(frontalis_left=0, frontalis_right=0)
        wait(lambda: all(abs(face.height(name) - rest[name]) < 0.5e-3 for name in BROWS), "both brows back")
        self.settle(face)
        for name in BROWS:
            self.assertLess(abs(face.height(name) - rest[name]), 0.5e-3)
        self.assertFalse(face.state.failed, face.state.message)

    def test_only_the_left_brow_goes_up_by_the_left_muscle(self):
        face = Face()
        face.wait_until_ready()
        before = face.state.time
        self.assertTrue(face.reset().success)
        wait(lambda: face.state.time < before and not any(face.state.activation), "rest")
        self.settle(face)
        rest = {name: face.height(name) for name in BROWS}
        face.command(frontalis_left=0.75)
        wait(lambda: face.height("brow_left") - rest["brow_left"] > 2e-3, "the left brow 2 mm up")
        self.assertLess(abs(face.height("brow_right") - rest["brow_right"]), 1e-3)
        face.command(frontalis_left=0)

    def settle(self, face):
        """Waits for half a second of simulated time."""
        end = face.state.time + 0.5
        wait(lambda: face.state.time > end, "half a simulated second")
        for pose in face.landmarks.poses:
            self.assertTrue(math.isfinite(pose.position.x + pose.position.y + pose.position.z))


if __name__ == "__main__":
    rospy.init_node("brow_test")
    rostest.rosrun("frontalis", "brow", Brow)
