#!/usr/bin/python3
"""A face under a changing load: subscribers come and go, commands of all kinds arrive, good and bad. Its memory stays flat, its
motion finite, and on a machine that is fast enough its frames come in time. ./dev test --long runs it for ten minutes."""

import math
import os
import random
import sys
import time
import unittest
import xmlrpc.client

import rosgraph
import rospy
import rostest
from frontalis.msg import SimulationState
from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import PointCloud2
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint
from visualization_msgs.msg import Marker, MarkerArray

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from face import Face  # noqa: E402

RATE = 30  # frames per second, as soak.test says
MEMORY = 2e6  # largest change of the memory after the warm-up [bytes]
MISSED = 0.01  # largest proportion of frames that are missed
FAST_ENOUGH = 0.98  # real-time factor of at least 95 % of the frames, unless other programs slow the machine down
TOPICS = {"skin": Marker, "skin_points": PointCloud2, "skin_field": PointCloud2, "muscles": MarkerArray, "wrench/skull": WrenchStamped}
MUSCLES = ["frontalis_left", "frontalis_right"]


def resident_bytes(pid):
    with open("/proc/%d/statm" % pid, encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGESIZE")


class Soak(unittest.TestCase):
    def setUp(self):
        self.face = Face()
        self.face.wait_until_ready()
        self.trajectory = rospy.Publisher("/face/joint_trajectory", JointTrajectory, queue_size=10)
        self.chance = random.Random(1)
        self.listeners = {}
        self.previous = None
        self.frames = self.missed = 0
        self.factors, self.failures = [], []

    def count(self, state):
        """Counts frames, and those that are missing in the time between two of them."""
        if self.previous is not None:
            frames = state.sequence - self.previous.sequence
            due = round(RATE * (state.header.stamp - self.previous.header.stamp).to_sec())
            self.frames += frames
            self.missed += max(0, due - frames)
        self.previous = state
        self.factors.append(state.real_time_factor)
        self.failures += [state.message] * state.failed

    def send_trajectory(self):
        message = JointTrajectory(joint_names=MUSCLES)
        for index in range(100):
            message.points.append(JointTrajectoryPoint(positions=[self.chance.random(), 0.5],
                                                       time_from_start=rospy.Duration(0.02 * (index + 1))))
        self.trajectory.publish(message)

    def toggle_listener(self):
        topic = self.chance.choice(list(TOPICS))
        if topic in self.listeners:
            self.listeners.pop(topic).unregister()
        else:
            self.listeners[topic] = rospy.Subscriber("/face/" + topic, TOPICS[topic], lambda message: None)

    def act(self):
        """One change of the load."""
        chance = self.chance.random()
        if chance < 0.6:
            self.face.send(MUSCLES, [self.chance.random(), self.chance.random()])
        elif chance < 0.7:
            self.face.express(self.chance.choice(["raise", "wink", "drop", "relax"]), onset=self.chance.random())
        elif chance < 0.8:
            self.toggle_listener()
        elif chance < 0.9:
            self.send_trajectory()
        elif chance < 0.93:
            self.face.switch_effect("contraction", self.chance.random() < 0.5)
        elif chance < 0.97:
            self.face.send(["nobody"] * 1000, [math.nan])
        else:
            self.face.list_muscles()

    def test_memory_and_frames_under_a_changing_load(self):
        seconds = rospy.get_param("soak_seconds")
        node = rosgraph.Master("soak").lookupNode("/face")
        pid = xmlrpc.client.ServerProxy(node).getPid("soak")[2]
        warm_up = min(60, seconds / 4)
        begin = time.monotonic()
        memory, counter = [], None
        while time.monotonic() - begin < seconds:
            self.act()
            time.sleep(self.chance.choice([0.001, 0.02, 0.1]))
            if time.monotonic() - begin > warm_up:
                counter = counter or rospy.Subscriber("/face/state", SimulationState, self.count)
                memory.append(resident_bytes(pid))
        self.assertTrue(self.factors, "no frames")
        missed = self.missed / max(1, self.frames + self.missed)
        change = max(memory) - min(memory)
        factor = sorted(self.factors)[len(self.factors) // 20]
        print("%d frames, %.2f %% missed; real-time factor %.3f; memory %.1f MB, changed by %.2f MB"
              % (self.frames, 100 * missed, factor, memory[-1] / 1e6, change / 1e6))
        self.assertEqual(self.failures, [])
        self.assertEqual(self.face.diagnostic("frames not published as not finite"), "0")
        self.assertLessEqual(change, MEMORY)
        if factor < FAST_ENOUGH:
            print("frames are not judged: the machine was too busy")
        else:
            self.assertGreater(self.frames, 0.9 * RATE * (seconds - warm_up))
            self.assertLessEqual(missed, MISSED)


if __name__ == "__main__":
    rospy.init_node("soak_test")
    rostest.rosrun("frontalis", "soak_test", Soak)
