#!/usr/bin/python3
"""A face ends when it is told to, whatever it is doing, and so do the programs that it started. The test prints how long that takes;
it asserts no time, since that depends on the load of the machine.
"""

import os
import signal
import subprocess
import tempfile
import threading
import time
import unittest

import actionlib
import roslib.packages
import rospkg
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from frontalis.msg import FitActivationAction, FitActivationGoal
from frontalis.srv import LoadScene
from geometry_msgs.msg import Vector3

from face import LIMIT, Face, wait

FOLDER = rospkg.RosPack().get_path("frontalis")
SMALL = os.path.join(FOLDER, "test/ros/small.yaml")
LARGE = os.path.join(FOLDER, "config/head.yaml")
LONG = "fine"  # with this profile its bake takes at least half a minute


class Node:
    """A face in a process of its own, with a cache of its own, so that it bakes its scene."""

    def __init__(self, name, scene, *parameters):
        self.cache = tempfile.TemporaryDirectory()
        self.process = subprocess.Popen(
            [roslib.packages.find_node("frontalis", "face_node")[0], "__name:=" + name, "_scene:=" + scene,
             "_cache:=" + self.cache.name, "_threads:=1", *parameters])
        self.face = Face("/" + name)
        self.face.wait_for_service()

    def programs(self):
        """Numbers of the processes that this one has started."""
        threads = "/proc/%d/task" % self.process.pid
        found = []
        for thread in os.listdir(threads):
            try:
                with open("%s/%s/children" % (threads, thread), encoding="ascii") as file:
                    found += file.read().split()
            except (FileNotFoundError, ProcessLookupError):
                pass  # the thread has ended
        return found

    def end(self):
        """Ends the process. Returns the seconds that took, and its return code."""
        started = self.programs()
        begin = time.monotonic()
        self.process.send_signal(signal.SIGINT)
        code = self.process.wait(LIMIT)
        seconds = time.monotonic() - begin
        wait(lambda: not any(os.path.exists("/proc/" + number) for number in started), "the end of its programs")
        self.cache.cleanup()
        return seconds, code


def call_in_vain(service, *arguments):
    """Calls a service that does not answer, in a thread of its own; again if the call is refused, as while a step is under way."""
    def call():
        try:
            while not service(*arguments).success:
                pass
        except rospy.ServiceException:
            pass  # the node has ended

    threading.Thread(target=call, daemon=True).start()


class Shutdown(unittest.TestCase):
    def start(self, *arguments):
        node = Node(*arguments)
        self.addCleanup(node.process.kill)
        return node

    def end(self, node, what):
        seconds, code = node.end()
        print("a face that %s ended after %.2f s" % (what, seconds))
        self.assertEqual(code, 0)

    def test_while_it_bakes(self):
        node = self.start("baking", LARGE, "_accuracy:=" + LONG)
        wait(node.programs, "the bake")
        self.end(node, "bakes")

    def test_while_it_runs(self):
        node = self.start("running", SMALL, "_demo:=true")
        node.face.wait_until_ready()
        self.end(node, "runs")

    def test_in_a_long_step(self):
        node = self.start("stepping", SMALL, "_pace:=lock_step")
        node.face.wait_until_ready()
        call_in_vain(node.face.step, 1e6)
        wait(lambda: "another step" in node.face.step(1e-9).message, "the step under way")
        self.end(node, "makes a long step")

    def test_while_it_fits(self):
        node = self.start("fitting", SMALL)
        node.face.wait_until_ready()
        client = actionlib.SimpleActionClient("/fitting/fit_activation", FitActivationAction)
        self.assertTrue(client.wait_for_server(rospy.Duration(LIMIT)))

        def is_fitting():
            """A fit may end before it is seen; then the next one is begun."""
            if client.get_state() not in (GoalStatus.PENDING, GoalStatus.ACTIVE):
                client.send_goal(FitActivationGoal(landmark=["tip"], target=[Vector3(0, 0, 1e-3)], runs=1000))
            return node.programs()

        wait(is_fitting, "the fit")
        self.end(node, "fits")

    def test_while_it_loads_another_scene(self):
        node = self.start("loading", SMALL)
        node.face.wait_until_ready()
        call_in_vain(rospy.ServiceProxy("/loading/load_scene", LoadScene), LARGE, "", LONG)
        wait(node.programs, "the bake of the other scene")
        # the present face goes on meanwhile, and takes commands
        time_before = node.face.state.time
        node.face.command(lift=0.5)
        wait(lambda: node.face.state.time > time_before + 0.05 and abs(node.face.state.activation[0] - 0.5) < 1e-3, "the present face")
        self.assertTrue(node.programs(), "the other scene is still being made")
        self.end(node, "loads another scene")


if __name__ == "__main__":
    rospy.init_node("shutdown_test")
    rostest.rosrun("frontalis", "shutdown", Shutdown)
