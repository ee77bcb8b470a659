#!/usr/bin/python3
"""Faces without a model stay alive, answer services, and say in /diagnostics what is wrong."""

import os
import unittest

import rospkg
import rospy
import rostest
from dynamic_reconfigure.client import Client
from frontalis.srv import LoadScene

from face import Face, wait

ERROR = 2


class Fault(unittest.TestCase):
    def check(self, name, *words):
        face = Face(name)
        face.wait_for_service()
        wait(lambda: face.diagnostics and face.diagnostics[0].level == ERROR, "an error of " + name)
        for word in words:
            self.assertIn(word, face.diagnostics[0].message)
        for answer in (face.list_muscles(), face.reset(), face.pause(True), face.step(0.1)):
            self.assertFalse(answer.success)
            self.assertEqual(answer.message, face.diagnostics[0].message)
        face.command(lift=0.5)
        wait(lambda: face.state is not None and face.state.failed, "a failed state")
        self.assertEqual(face.state.message, face.diagnostics[0].message)
        self.assertFalse(face.list_muscles().success)

    def test_scene_that_is_not_there(self):
        self.check("/no_file", "nowhere.yaml")
        answer = rospy.ServiceProxy("/no_file/load_scene", LoadScene)(scene="")
        self.assertFalse(answer.success)
        self.assertIn("scene: found nothing; must be the path of a scene file", answer.message)
        answer = rospy.ServiceProxy("/no_file/load_scene", LoadScene)(scene="mine.yaml")
        self.assertFalse(answer.success)
        self.assertIn("the folder in which this node runs; give an absolute path, such as $PWD/mine.yaml", answer.message)
        scene = os.path.join(rospkg.RosPack().get_path("frontalis"), "test/ros/small.yaml")
        answer = rospy.ServiceProxy("/no_file/load_scene", LoadScene)(scene=scene)
        self.assertTrue(answer.success, answer.message)
        # the face that comes late can be configured as any other
        self.assertIn("skin_colour", Client("/no_file", timeout=60).get_configuration())

    def test_scene_with_a_fault(self):
        self.check("/bad_scene", "five_faults.yaml:")

    def test_node_without_a_scene_can_load_one(self):
        scene = os.path.join(rospkg.RosPack().get_path("frontalis"), "test/ros/small.yaml")
        self.check("/no_scene", "neither ~scene nor ~model")
        answer = rospy.ServiceProxy("/no_scene/load_scene", LoadScene)(scene=scene)
        self.assertTrue(answer.success, answer.message)

    def test_bad_parameters_are_told_all_at_once(self):
        self.check("/bad_parameters", "~scene nor ~model", "pace", "'slow'", "lock_step", "threads", "backend")

    def test_parameters_of_the_wrong_type(self):
        self.check("/bad_texts", "bone_frames: has the wrong type; allowed is a mapping", "effects_off", "'viscocity'",
                   "damping: has the wrong type")
        self.check("/bad_rate", "frame_rate: found 2000; allowed are 0 (the model's) or 0.1 to 1000")
        self.check("/bad_frames", "bone_frames/jaw: allowed is the name of a frame, or a mapping with frame and rest")

    def test_program_that_is_not_there(self):
        self.check("/no_program", "/nowhere/frontalis")


if __name__ == "__main__":
    rospy.init_node("fault_test")
    rostest.rosrun("frontalis", "fault", Fault)
