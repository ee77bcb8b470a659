#!/usr/bin/python3
"""A nodelet that plays its demo in real time: pace, pause, the demo and those who take over from it."""

import time
import unittest

import rospy
import rostest

from face import Face, wait


class Live(unittest.TestCase):
    def setUp(self):
        self.face = Face()
        self.face.wait_until_ready(60)

    def test_1_time_runs_no_faster_than_the_clock(self):
        wait(lambda: self.face.state.time > 0.5, "half a second", 60)
        begin, clock = self.face.state.time, time.monotonic()
        rospy.sleep(2)
        ran, took = self.face.state.time - begin, time.monotonic() - clock
        self.assertGreater(ran, 0.2)
        self.assertLess(ran, took + 0.3)
        self.assertLess(self.face.state.real_time_factor, 1.2)
        self.assertGreater(self.face.state.real_time_factor, 0.1)

    def test_1_accuracy_and_speed_are_told(self):
        def told(key):
            return [pair.value for status in self.face.diagnostics for pair in status.values if pair.key == key and pair.value]

        wait(lambda: told("speed"), "the speed", 60)
        self.assertIn("of real time", told("speed")[0])
        self.assertIn("profile 'draft': its skin was measured to be off by 0.5 mm", told("accuracy")[0])

    def test_2_demo_moves_the_muscle_up_and_down(self):
        wait(lambda: self.face.state.activation[0] > 0.4, "contraction", 60)
        wait(lambda: self.face.state.activation[0] < 0.1, "relaxation", 60)
        wait(lambda: self.face.state.activation[0] > 0.4, "contraction in the second round", 60)

    def test_3_pause_stops_the_clock_and_goes_on(self):
        self.assertTrue(self.face.pause(True).success)
        wait(lambda: self.face.state.paused, "the pause", 10)
        rospy.sleep(0.7)
        begin = self.face.state.time
        rospy.sleep(0.7)
        self.assertEqual(self.face.state.time, begin)
        self.assertTrue(self.face.pause(False).success)
        wait(lambda: self.face.state.time > begin + 0.1 and not self.face.state.paused, "going on", 30)

    def test_4_a_command_takes_over_and_reset_gives_back(self):
        self.face.command(lift=0.9)
        wait(lambda: self.face.state.activation[0] > 0.85, "the command", 30)
        begin = self.face.state.time
        wait(lambda: self.face.state.time > begin + 0.7, "more than a round of the demo", 60)
        self.assertGreater(self.face.state.activation[0], 0.85)
        self.assertTrue(self.face.reset().success)
        wait(lambda: self.face.state.activation[0] < 0.1, "rest", 30)
        wait(lambda: 0.4 < self.face.state.activation[0] < 0.6, "the demo", 30)


if __name__ == "__main__":
    rospy.init_node("live_test")
    rostest.rosrun("frontalis", "live", Live)
