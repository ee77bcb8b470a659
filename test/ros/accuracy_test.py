#!/usr/bin/python3
"""A profile that `frontalis accuracy --save` wrote drives a face, which tells what was measured, how fast it runs, and where that is
too slow which profile would do."""

import os
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

    def start(self, name, profile):
        # what it says as soon as it is there would be gone before /rosout is connected
        node = subprocess.Popen(
            [program("face_node"), "__name:=" + name, "_scene:=" + SCENE, "_accuracy:=" + profile, "_threads:=1"],
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
        face.wait_until_ready(60)
        return face

    def line(self, name, words):
        """The first that the face logs with these words."""

        def lines():
            return [text for who, text in self.said if who == name and words in text]

        wait(lines, "a line of %s with '%s'" % (name, words), 60)
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
        self.assertIn("voxel: 5 mm", saved)
        face = self.start("chosen", profile)
        told = self.line("chosen", "accuracy profile 'chosen'")
        self.assertIn("mm RMS, and a simulated second to take", told)
        # the same figures, to two digits, and the machine
        error, cost = (float(saved.split(key)[1].split(",")[0].split(" mm")[0]) for key in ("error: ", "cost: "))
        self.assertIn("off by %.2g mm RMS" % error, told)
        self.assertIn("to take %.2g s on %s" % (cost, saved.split('machine: "')[1].split('"')[0]), told)
        self.assertIn("of real time here", self.line("chosen", "runs at"))
        self.assertGreater(face.state.real_time_factor, 0)

    def test_a_machine_that_is_too_slow_is_told_what_would_do(self):
        profile = os.path.join(self.folder.name, "fine.yaml")
        with open(profile, "w", encoding="utf-8") as file:
            file.write('finest: {voxel: 0.6 mm, measured: {error: 0.05 mm, cost: 5, machine: "a bench"}}\n')
        self.start("slow", profile)
        self.assertIn("off by 0.05 mm RMS, and a simulated second to take 5 s on a bench", self.line("slow", "'finest'"))
        speed = self.line("slow", "runs at")
        self.assertIn("too slow for real time; profile 'draft' would do: about", speed)
        self.assertIn("its skin off by 0.5 mm RMS", speed)


if __name__ == "__main__":
    rospy.init_node("accuracy_test")
    rostest.rosrun("frontalis", "accuracy", Accuracy)
