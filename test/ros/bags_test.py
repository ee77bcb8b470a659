#!/usr/bin/python3
"""Bags: one that is replayed twice in lock-step gives the same bytes of outputs; landmarks and joints of one become tables."""

import csv
import io
import os
import random
import subprocess
import tempfile
import unittest

import rosbag
import rospy
import rostest
from frontalis.msg import Expression, MuscleActivation, SimulationState
from geometry_msgs.msg import Point, Pose, PoseArray
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

SCRIPTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../src/ros/")
START = 1000.25  # time of the first command [s]
TOPICS = ("state", "landmarks", "skin_points", "wrench/skull")


def write_commands(path):
    """Writes half a second of random activations, and a trajectory and an expression among them."""
    chance = random.Random(1)
    with rosbag.Bag(path, "w") as bag:
        for index in range(25):
            now = rospy.Time.from_sec(START + 0.02 * index)
            muscle = MuscleActivation(name=["frontalis_right"], activation=[chance.random()])
            muscle.header.stamp = now
            bag.write("/face/muscle_activation", muscle, now)
        now = rospy.Time.from_sec(START + 0.11)
        points = [JointTrajectoryPoint(positions=[0.7], time_from_start=rospy.Duration(0.15)),
                  JointTrajectoryPoint(positions=[0.1], time_from_start=rospy.Duration(0.25))]
        trajectory = JointTrajectory(joint_names=["frontalis_left"], points=points)
        trajectory.header.stamp = now + rospy.Duration(0.03)
        bag.write("/face/joint_trajectory", trajectory, now)
        bag.write("/face/expression", Expression(name=["drop"], onset=0.1), rospy.Time.from_sec(START + 0.33))


def bytes_of(message):
    """The message without wall-clock fields, and without the number that ROS gives each message of a publisher."""
    message.header.seq = 0
    for field in ("wall_time", "real_time_factor", "sequence"):
        if hasattr(message, field):
            setattr(message, field, 0)
    text = io.BytesIO()
    message.serialize(text)
    return text.getvalue()


class Bags(unittest.TestCase):
    def run_script(self, *command):
        done = subprocess.run([SCRIPTS + command[0], *command[1:]], capture_output=True, check=False, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)

    def replayed(self, commands, output, *options):
        self.run_script("replay_bag.py", commands, output, "--topics", *TOPICS, *options)
        with rosbag.Bag(output) as bag:
            return [(topic, stamp.to_nsec(), message) for topic, message, stamp in bag.read_messages()]

    def table(self, path):
        with open(path, newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_landmarks_and_joints_become_tables(self):
        """The joint stands still at 0, 2 and 5 mm for 0.1 s or more; the landmark rises by twice that. Messages of joints are rarer than
        those of landmarks, and come from two nodes; one joint has noise."""
        with tempfile.TemporaryDirectory() as folder:
            with rosbag.Bag(folder + "/babbling.bag", "w") as bag:
                # rosbag record stores names of topics as they were given
                bag.write("face/state", SimulationState(landmark=["tip"]), rospy.Time(9))
                for index in range(120):
                    now = rospy.Time.from_sec(10 + 0.01 * index)
                    position = min(2e-3, max(0, 1e-4 * (index - 14))) + min(3e-3, max(0, 1e-4 * (index - 64)))
                    if index % 4 == 0:
                        joint = JointState(name=["lift"], position=[position], effort=[1e3 * position])
                        bag.write("joint_states", joint, now)
                    elif index % 4 == 2:
                        bag.write("joint_states", JointState(name=["turn"], position=[0.3 + 2e-5 * (index % 3)]), now)
                    tip = Pose(position=Point(0.1, 0, 2 * position - 0.05))
                    bag.write("/face/landmarks", PoseArray(poses=[tip]), now + rospy.Duration(0.001))
            self.run_script("read_bag.py", folder + "/babbling.bag", folder, "--still", "0.05")
            joints, landmarks = self.table(folder + "/joints.csv"), self.table(folder + "/landmarks.csv")
            self.assertEqual([(float(row["lift"]), float(row["lift.effort"])) for row in joints], [(0, 0), (0.002, 2), (0.005, 5)])
            for row in joints:
                self.assertAlmostEqual(float(row["turn"]), 0.3, delta=1e-4)
                self.assertNotIn("turn.effort", row)
            self.assertEqual([row["landmark"] for row in landmarks], ["tip"] * 3)
            self.assertEqual([float(row["up_mm"]) for row in landmarks], [0, 4, 10])
            self.assertEqual([row["time_s"] for row in joints], [row["time_s"] for row in landmarks])
            self.run_script("read_bag.py", folder + "/babbling.bag", folder, "--rate", "10")
            track = self.table(folder + "/landmarks.csv")
            self.assertEqual(float(track[0]["time_s"]), 0)
            self.assertEqual(len(track), 12)
            with self.assertRaisesRegex(AssertionError, "no pose in which all joints on /joint_states stand still for 5 s"):
                self.run_script("read_bag.py", folder + "/babbling.bag", folder, "--still", "5")
            with self.assertRaisesRegex(AssertionError, "has no messages on /joints, but on .*joint_states"):
                self.run_script("read_bag.py", folder + "/babbling.bag", folder, "--still", "0.05", "--joints", "joints")

    def test_plays_the_last_command_and_one_frame_for_each_moment(self):
        """Commands come at the ends of frames, in nanoseconds. The long step of a moving face has pieces that are not published."""
        states = []
        listener = rospy.Subscriber("/face/state", SimulationState, states.append, queue_size=1000)
        with tempfile.TemporaryDirectory() as folder:
            with rosbag.Bag(folder + "/commands.bag", "w") as bag:
                bag.write("/face/expression", Expression(name=["drop"], onset=1), rospy.Time(10))
                for index in range(1, 11):
                    now = rospy.Time(10, index * 10**9 // 30)
                    command = MuscleActivation(name=["frontalis_right"], activation=[0.7 if index == 10 else 0.2])
                    bag.write("/face/muscle_activation", command, now)
            for rate, frames in ((30, 11), (10, 4)):
                states.clear()
                output = self.replayed(folder + "/commands.bag", folder + "/output.bag", "--rate", str(rate))
                written = [message for topic, _, message in output if topic == "/face/state"]
                for frame, state in enumerate(written):
                    self.assertAlmostEqual(state.time, (frame + 1) / rate, 9)
                self.assertEqual(len(written), frames)
                right = written[-1].name.index("frontalis_right")
                self.assertAlmostEqual(written[-1].activation[right], 0.7, 6)
                stamps = [state.header.stamp for state in states]
                self.assertEqual(len(stamps), len(set(stamps)))
                self.assertGreaterEqual(len(stamps), frames)
        listener.unregister()

    def test_gives_equal_bytes(self):
        with tempfile.TemporaryDirectory() as folder:
            write_commands(folder + "/commands.bag")
            first = self.replayed(folder + "/commands.bag", folder + "/first.bag")
            second = self.replayed(folder + "/commands.bag", folder + "/second.bag")
        self.assertEqual(len(first), 15 * len(TOPICS))  # frames of 0.48 s
        states = [message for topic, _, message in first if topic == "/face/state"]
        self.assertAlmostEqual(states[-1].time, 0.5, 9)
        self.assertGreater(max(state.activation[0] for state in states), 0.5)  # the trajectory
        heights = [message.poses[0].position.z for topic, _, message in first if topic == "/face/landmarks"]
        self.assertGreater(max(heights) - min(heights), 1e-3)
        self.assertEqual([entry[:2] for entry in first], [entry[:2] for entry in second])
        for one, other in zip(first, second):
            self.assertEqual(bytes_of(one[2]), bytes_of(other[2]), "%s at %d ns" % one[:2])


if __name__ == "__main__":
    rospy.init_node("bags_test", disable_signals=True)
    rostest.rosrun("frontalis", "bags_test", Bags)
