#!/usr/bin/python3
"""The action ~fit_activation finds the activation of a pose, applies it, refuses bad goals, and can be cancelled."""

import math
import os
import subprocess
import tempfile
import unittest

import actionlib
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from frontalis.msg import FitActivationAction, FitActivationGoal
from geometry_msgs.msg import Vector3

from face import Face, LIMIT, wait

PLAYER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../src/ros/play_track.py")


class Fit(unittest.TestCase):
    def setUp(self):
        self.face = Face()
        self.face.wait_until_ready()
        self.assertTrue(self.face.reset().success)
        self.face.wait_for_frame(lambda: self.face.state.time == 0 and self.face.target() == {"lift": 0}, "the reset")
        self.client = actionlib.SimpleActionClient("/face/fit_activation", FitActivationAction)
        self.assertTrue(self.client.wait_for_server(rospy.Duration(LIMIT)))
        self.stages = []

    def send(self, **fields):
        self.client.send_goal(FitActivationGoal(**fields), feedback_cb=lambda message: self.stages.append(message.stage))

    def outcome(self):
        self.assertTrue(self.client.wait_for_result(rospy.Duration(LIMIT)))
        return self.client.get_state()

    def test_finds_the_activation_that_lifted_the_tip_and_applies_it(self):
        rest = self.face.height("tip")
        self.face.command(lift=0.4)
        wait(lambda: self.face.target() == {"lift": 0.4}, "the command")
        self.assertTrue(self.face.step(1.0).success)
        self.face.wait_for_frame(lambda: self.face.state.time > 0.99, "the state and its landmarks")
        lifted = self.face.height("tip") - rest
        self.assertGreater(lifted, 1e-3)
        self.assertTrue(self.face.reset().success)
        self.send(landmark=["tip"], target=[Vector3(math.nan, math.nan, lifted)], runs=-1, apply=True)
        self.assertEqual(self.outcome(), GoalStatus.SUCCEEDED, self.client.get_goal_status_text())
        result = self.client.get_result()
        self.assertEqual(result.name, ["lift"])
        self.assertAlmostEqual(result.value[0], 0.4, delta=0.05)
        self.assertTrue(result.determined[0])
        self.assertAlmostEqual(result.covariance[0], result.deviation[0] ** 2, 9)
        self.assertLess(result.error[0], 0.1e-3)
        self.assertLessEqual(len(result.errors), 5)
        self.assertTrue(any("refining" in stage for stage in self.stages), self.stages)
        wait(lambda: abs(self.face.target()["lift"] - result.value[0]) < 1e-6, "the activation")

    def test_refuses_goals_that_make_no_sense(self):
        for fields, fault in (
            ({"landmark": ["nose"], "target": [Vector3()]}, "no landmark is called 'nose'; the landmarks are tip"),
            ({"landmark": ["tip"], "target": []}, "target: found 0 entries; must be 1, one per landmark"),
            ({"landmark": [], "target": []}, "no targets"),
            ({"landmark": ["tip"], "target": [Vector3(math.inf, 0, 0)]}, "NaN leaves one free"),
            ({"landmark": ["tip"], "target": [Vector3()], "unknown": ["a: [1"]}, "a: [1"),
            ({"landmark": ["tip"], "target": [Vector3()], "unknown": ["lift"], "lower": [0], "upper": []}, "upper"),
            ({"landmark": ["tip"], "target": [Vector3()], "deviation": -1}, "deviation"),
            ({"landmark": ["tip"], "target": [Vector3(0, 0, 6)]}, "targets are in metres"),
            ({"landmark": ["tip"], "target": [Vector3()], "unknown": ["jaw.x"]}, "needs limits"),
            ({"landmark": ["tip"], "target": [Vector3()], "unknown": ["jaw.x"], "lower": [0], "upper": [1], "apply": True}, "muscles only"),
        ):
            self.send(**fields)
            self.assertEqual(self.outcome(), GoalStatus.ABORTED, fault)
            self.assertIn(fault, self.client.get_goal_status_text())
        self.assertEqual(self.face.target(), {"lift": 0})

    def test_a_table_is_played_as_a_trajectory(self):
        with tempfile.NamedTemporaryFile("w", suffix=".csv") as table:
            table.write("time,lift,jaw.x\n0,0,1\n0.2,0.6,1\n0.4,0.3,1\n")
            table.flush()
            before = self.face.list_muscles().messages
            played = subprocess.run([PLAYER, table.name, "/face"], capture_output=True, check=True, text=True)
        self.assertIn("left out: jaw.x", played.stderr)
        wait(lambda: self.face.list_muscles().messages > before, "the trajectory")
        self.assertTrue(self.face.step(0.4).success)
        wait(lambda: abs(self.face.target()["lift"] - 0.3) < 1e-6, "the end of the table")

    def test_can_be_cancelled(self):
        for _ in range(20):
            self.send(landmark=["tip"], target=[Vector3(0, 0, 1e-3)], runs=-1, apply=True)
            self.client.cancel_goal()
            outcome = self.outcome()
            if outcome != GoalStatus.SUCCEEDED:
                break
            # the fit ended before it could be cancelled
            self.face.command(lift=0)
            wait(lambda: self.face.target() == {"lift": 0}, "the muscle to relax")
        self.assertIn(outcome, (GoalStatus.PREEMPTED, GoalStatus.RECALLED))
        self.assertEqual(self.face.target(), {"lift": 0})


if __name__ == "__main__":
    rospy.init_node("fit_test")
    rostest.rosrun("frontalis", "fit_test", Fit)
