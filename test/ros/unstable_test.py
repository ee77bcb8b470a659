#!/usr/bin/python3
"""A motion that no time step makes stable is stopped with a reason. The last good skin stays, and ~reset starts again."""

import math
import struct
import unittest

import rospy
import rostest
from sensor_msgs.msg import PointCloud2

from face import Face, wait

OK, ERROR = 0, 2


class Unstable(unittest.TestCase):
    def take_skin(self, message):
        self.skins += 1
        for vertex in range(message.width):
            numbers = struct.unpack_from("<6f", message.data, vertex * message.point_step)
            self.finite = self.finite and all(math.isfinite(x) and abs(x) < 1 for x in numbers)

    def test_it_is_stopped_explained_and_goes_on_after_reset(self):
        self.skins, self.finite = 0, True
        face = Face()
        rospy.Subscriber("/face/skin_points", PointCloud2, self.take_skin)
        face.wait_until_ready()
        for _ in range(2):
            good = face.step(0.1)
            self.assertTrue(good.success, good.message)
            wait(lambda: face.diagnostics and face.diagnostics[0].level == OK, "good diagnostics")
            bad = face.step(0.4)
            self.assertFalse(bad.success)
            for word in ("unstable", "inside out", "voxel", "mm in the scene", "flesh", "press", "ramp"):
                self.assertIn(word, bad.message)
            wait(lambda: face.state.failed and face.diagnostics[0].level == ERROR, "the failure")
            self.assertEqual(face.state.message, bad.message)
            self.assertEqual(face.diagnostics[0].message, bad.message)
            values = {pair.key: pair.value for pair in face.diagnostics[0].values}
            self.assertGreaterEqual(int(values["returns to an earlier stable state"]), 3)
            # services still answer, and the last good skin is still published
            self.assertTrue(face.list_muscles().success)
            self.assertIn("reset", face.step(0.1).message)
            shown = self.skins
            wait(lambda: self.skins > shown, "the last good skin")
            self.assertTrue(face.reset().success)
            wait(lambda: face.state.time == 0 and not face.state.failed, "the reset")
        self.assertTrue(self.finite)


if __name__ == "__main__":
    rospy.init_node("unstable_test")
    rostest.rosrun("frontalis", "unstable", Unstable)
