#!/usr/bin/python3
"""A nodelet that plays its demo in real time: its pace, the pause, the demo, and commands that end the demo."""

import unittest

import rospy
import rostest
from visualization_msgs.msg import Marker

from face import Face, wait


class Live(unittest.TestCase):
    def setUp(self):
        self.face = Face()
        self.face.wait_until_ready()

    def test_1_time_runs_no_faster_than_the_clock(self):
        wait(lambda: self.face.state.time > 0.5 and self.face.state.wall_time > 2, "half a second")
        begin = self.face.state
        wait(lambda: self.face.state.time > begin.time + 0.5 and self.face.state.real_time_factor > 0.1, "the pace")
        end = self.face.state
        # at 30 frames per second, simulated time may be one frame ahead of the clock and make up for two late frames
        self.assertLess(end.time - begin.time, end.wall_time - begin.wall_time + 0.11)
        self.assertLess(end.real_time_factor, 1.11)

    def test_1_accuracy_and_speed_are_told(self):
        def told(key):
            return [pair.value for status in self.face.diagnostics for pair in status.values if pair.key == key and pair.value]

        wait(lambda: told("speed"), "the speed")
        self.assertIn("real-time factor", told("speed")[0])
        self.assertIn("profile 'draft': measured skin error 0.5 mm", told("accuracy")[0])

    def test_2_demo_moves_the_muscle_up_and_down(self):
        wait(lambda: self.face.state.activation[0] > 0.4, "contraction")
        wait(lambda: self.face.state.activation[0] < 0.1, "relaxation")
        wait(lambda: self.face.state.activation[0] > 0.4, "contraction in the second round")

    def test_2_caption_names_the_expression_of_the_demo(self):
        captions = []
        rospy.Subscriber("/face/caption", Marker, lambda message: captions.append(message.text))
        for text in ("shorten", "relax"):
            wait(lambda text=text: any(caption.startswith(text) for caption in captions), "the caption " + text)

    def test_3_pause_stops_the_clock_and_goes_on(self):
        self.assertTrue(self.face.pause(True).success)
        wait(lambda: self.face.state.paused, "the pause")
        self.face.wait_for_states(2)  # one more frame may have been in progress
        begin = self.face.state.time
        self.face.wait_for_states(2)
        self.assertEqual(self.face.state.time, begin)
        self.assertTrue(self.face.pause(False).success)
        wait(lambda: self.face.state.time > begin + 0.1 and not self.face.state.paused, "going on")

    def test_4_a_command_takes_over_and_reset_gives_back(self):
        self.face.command(lift=0.9)
        wait(lambda: self.face.state.activation[0] > 0.85, "the command")
        begin = self.face.state.time
        wait(lambda: self.face.state.time > begin + 0.7, "more than a round of the demo")
        self.assertGreater(self.face.state.activation[0], 0.85)
        self.assertTrue(self.face.reset().success)
        wait(lambda: self.face.state.activation[0] < 0.1, "rest")
        wait(lambda: 0.4 < self.face.state.activation[0] < 0.6, "the demo")


if __name__ == "__main__":
    rospy.init_node("live_test")
    rostest.rosrun("frontalis", "live", Live)
