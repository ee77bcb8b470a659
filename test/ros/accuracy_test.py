#!/usr/bin/python3
"""A face that runs with a profile of `frontalis accuracy --save` logs the profile's measured error and cost and its own real-time
factor. If it is too slow, it names the profile that would run in real time.
"""

import os
import re
import subprocess
import tempfile
import threading
import unittest

import roslib.packages
import rospkg
import rospy
import rostest

from face import Face, wait

SCENE = os.path.join(rospkg.RosPack().get_path("frontalis"), "test/ros/small.yaml")


def program(name):
    return roslib.packages.find_node("frontalis", name)[0]


class Accuracy(unittest.TestCase):
    def setUp(self):
        self.said = []
        self.folder = tempfile.TemporaryDirectory()

    def tearDown(self):
        self.folder.cleanup()

    def start(self, name, profile, backend="cpu"):
        # the log is read from the process, since the first lines come before /rosout is connected
        node = subprocess.Popen(
            [program("face_node"), "__name:=" + name, "_scene:=" + SCENE, "_accuracy:=" + profile, "_threads:=1",
             "_backend:=" + backend],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            universal_newlines=True,
            env=dict(os.environ, ROSCONSOLE_STDOUT_LINE_BUFFERED="1"),
        )
        listening = threading.Thread(target=lambda: self.said.extend((name, line) for line in node.stdout))
        listening.start()
        self.addCleanup(listening.join)
        self.addCleanup(node.wait)
        self.addCleanup(node.terminate)
        face = Face("/" + name)
        face.wait_until_ready()
        return face

    def line(self, name, words):
        """Returns the first line of the face's log that contains the words."""

        def lines():
            return [text for who, text in self.said if who == name and words in text]

        wait(lines, "a line of %s with '%s'" % (name, words))
        return lines()[0]

    def test_a_saved_profile_is_taken_and_told(self):
        profile = os.path.join(self.folder.name, "chosen.yaml")
        command = [program("frontalis"), "accuracy", SCENE, "--quick", "--knobs", "voxel", "--voxels", "5,2.5,2"]
        done = subprocess.run(
            command + ["--tolerance", "5", "--save", profile, "-o", os.path.join(self.folder.name, "study")],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            universal_newlines=True,
            check=False,
        )
        self.assertEqual(done.returncode, 0, done.stdout)
        with open(profile, encoding="utf-8") as file:
            saved = file.read()
        # which of them is cheapest depends on the machine and its load
        self.assertRegex(saved, r"voxel: (5|2\.5|2) mm")
        face = self.start("chosen", profile)
        told = self.line("chosen", "accuracy profile 'chosen'")
        # the log has the same figures, rounded to two digits
        error, cost, machine = re.search(r'error: ([^ ]+) mm, cost: ([^,]+), machine: "(.*)"', saved).groups()
        logged = re.search(r"measured skin error ([^ ]+) mm RMS, measured cost ([^ ]+) s per simulated second on (.*)", told)
        self.assertLess(abs(float(logged.group(1)) - float(error)), 0.06 * float(error))
        self.assertLess(abs(float(logged.group(2)) - float(cost)), 0.06 * float(cost))
        self.assertIn(machine, logged.group(3))
        self.line("chosen", "real-time factor")
        self.assertGreater(face.state.real_time_factor, 0)

    def test_a_machine_that_is_too_slow_is_told_what_would_do(self):
        profile = os.path.join(self.folder.name, "fine.yaml")
        with open(profile, "w", encoding="utf-8") as file:
            file.write('finest: {voxel: 0.6 mm, measured: {error: 0.05 mm, cost: 5, machine: "a bench"}}\n')
        # on any machine, the reference backend is too slow for this number of voxels
        self.start("slow", profile, "reference")
        self.assertIn("skin error 0.05 mm RMS, measured cost 5 s per simulated second on a bench", self.line("slow", "'finest'"))
        speed = self.line("slow", "real-time factor")
        self.assertIn("too slow for real time; profile 'draft' would run in real time: about", speed)
        self.assertIn("skin error 0.5 mm RMS", speed)


if __name__ == "__main__":
    rospy.init_node("accuracy_test")
    rostest.rosrun("frontalis", "accuracy", Accuracy)
