#!/usr/bin/python3
"""The controllers of doc/ros.md move the face. The face relaxes when its controller is killed, and follows the next controller."""

import os
import subprocess
import unittest

import roslib.packages
import rospkg
import rospy
import rostest

from face import Face, wait

FOLDER = rospkg.RosPack().get_path("frontalis")


def source(name):
    with open(os.path.join(FOLDER, name), encoding="utf-8") as file:
        return file.read()


class Controllers(unittest.TestCase):
    def control(self, program):
        face = Face()
        face.wait_until_ready()
        for _ in range(2):
            controller = subprocess.Popen([program])
            self.addCleanup(controller.wait)
            self.addCleanup(controller.kill)
            wait(lambda: all(abs(a - 0.75) < 1e-3 for a in face.state.activation), "the controller")
            controller.kill()
            controller.wait()
            wait(lambda: all(a < 1e-3 for a in face.state.activation), "the relaxation")

    def test_python(self):
        self.control(os.path.join(FOLDER, "test/ros/controller.py"))

    def test_cpp(self):
        self.control(roslib.packages.find_node("frontalis", "ros_controller")[0])

    def test_document_shows_these_programs(self):
        document = source("doc/ros.md")
        self.assertIn(source("test/ros/controller.py").split("\n", 1)[1], document)
        self.assertIn(source("test/ros/controller.cpp"), document)


if __name__ == "__main__":
    rospy.init_node("controllers_test")
    rostest.rosrun("frontalis", "controllers", Controllers)
