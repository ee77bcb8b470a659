#!/usr/bin/python3
"""Timed, mapped and faulty inputs, and the watchdog. The face runs in lock-step, so that every activation is exact."""

import math
import time
import unittest

import rospy
import rostest
from dynamic_reconfigure.client import Client
from frontalis.msg import ActionUnits, Blendshapes, Expression, MuscleActivation
from geometry_msgs.msg import TransformStamped
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from face import LIMIT, Face, wait

LEFT, RIGHT = "frontalis_left", "frontalis_right"


def trajectory(names, *points):
    """Returns a trajectory. Each point is a pair of a time [s] and a list of positions."""
    return JointTrajectory(
        joint_names=names,
        points=[JointTrajectoryPoint(positions=list(p), time_from_start=rospy.Duration(t)) for t, p in points])


class Inputs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.face = Face()
        cls.face.wait_until_ready()
        cls.config = Client("/face", timeout=LIMIT)
        cls.warnings = []
        rospy.Subscriber("/rosout", Log, lambda log: cls.warnings.append(log.msg) if "refused" in log.msg else None)
        cls.lacking = []
        rospy.Subscriber("/rosout", Log, lambda log: cls.lacking.append(log.msg) if "tongueOut" in log.msg else None)
        cls.topics = {}
        for name, kind in (("joint_states", JointState), ("joint_trajectory", JointTrajectory), ("blendshapes", Blendshapes),
                           ("action_units", ActionUnits),
                           ("bone_pose", TransformStamped)):
            cls.topics[name] = rospy.Publisher("/face/" + name, kind, queue_size=10)
        cls.topics["muscle_activation"] = cls.face.activation
        cls.topics["expression"] = cls.face.expression
        wait(lambda: all(topic.get_num_connections() for topic in cls.topics.values()), "connections")

    def setUp(self):
        self.config.update_configuration({"command_timeout": 0, "relax_time": 0.5, "stamp_tolerance": 1e6})
        self.assertTrue(self.face.reset().success)

    def taken(self, topic):
        return int(self.face.diagnostic("messages taken on ~" + topic) or 0)

    def refused(self, topic):
        return int(self.face.diagnostic("messages refused on ~" + topic) or 0)

    def send(self, topic, message):
        """Sends a message and waits until the face has taken it."""
        self.deliver(topic, message, self.taken)

    def send_in_vain(self, topic, message):
        """Sends a message and waits until the face has refused it."""
        self.deliver(topic, message, self.refused)

    def deliver(self, topic, message, count):
        # before counting, wait until the face has processed all earlier messages
        self.wait_for_diagnostics()
        before = count(topic)
        self.topics[topic].publish(message)
        wait(lambda: count(topic) > before, "a count of messages on ~" + topic)

    def wait_for_diagnostics(self):
        self.face.diagnostics = []
        wait(lambda: self.face.diagnostics, "diagnostics")

    def step(self, seconds):
        """Steps and returns the activations after the step."""
        answer = self.face.step(seconds)
        self.assertTrue(answer.success, answer.message)
        wait(lambda: abs(self.face.state.time - answer.time) < 1e-9, "the state")
        return dict(zip(self.face.state.name, self.face.state.activation))

    def check(self, found, left, right):
        self.assertAlmostEqual(found[LEFT], left, 4)
        self.assertAlmostEqual(found[RIGHT], right, 4)

    def test_trajectory_is_interpolated_in_simulated_time(self):
        self.send("joint_trajectory", trajectory([LEFT, RIGHT], (0.2, (0.4, 0)), (0.4, (0.4, 0.6)), (0.5, (0, 0.6))))
        self.check(self.step(0.1), 0.2, 0)
        self.check(self.step(0.1), 0.4, 0)
        self.check(self.step(0.1), 0.4, 0.3)
        self.check(self.step(0.15), 0.2, 0.6)
        self.check(self.step(1), 0, 0.6)
        # a trajectory without points stops the muscle at its present activation
        self.send("joint_trajectory", trajectory([LEFT], (1, (1,))))
        self.check(self.step(0.5), 0.5, 0.6)
        self.send("joint_trajectory", trajectory([LEFT]))
        self.check(self.step(1), 0.5, 0.6)

    def test_the_last_writer_of_a_muscle_has_it(self):
        self.send("joint_trajectory", trajectory([LEFT, RIGHT], (1, (1, 1))))
        self.step(0.5)
        self.send("joint_states", JointState(name=[LEFT], position=[0.1]))
        self.check(self.step(0.25), 0.1, 0.75)
        # expressions, action units and blendshapes command the whole face
        self.send("expression", Expression(name=["wink"], onset=0.5))
        self.check(self.step(0.25), 0.35, 0.375)
        self.send("joint_states", JointState(name=[RIGHT], position=[0.7]))
        self.check(self.step(0.25), 0.6, 0.7)
        self.send("blendshapes", Blendshapes(name=["browOuterUpRight"], weight=[0.5]))
        self.check(self.step(0.25), 0, 0.3)

    def test_expression_goes_there_stays_and_relaxes(self):
        self.send("expression", Expression(name=["raise"], onset=0.2, hold=0.3, release=0.4))
        self.check(self.step(0.1), 0.4, 0.4)
        self.check(self.step(0.1), 0.8, 0.8)
        self.check(self.step(0.3), 0.8, 0.8)
        self.check(self.step(0.1), 0.6, 0.6)
        self.check(self.step(0.3), 0, 0)

    def test_expressions_are_added(self):
        self.send("expression", Expression(name=["raise", "wink"], intensity=[0.5, 0.25]))
        self.check(self.step(0.1), 0.55, 0.4)
        self.send("expression", Expression(name=["raise", "wink"]))
        self.check(self.step(0.1), 1, 0.8)
        # the face moves from its present state to an expression that lasts until the next command
        self.send("expression", Expression(name=["wink"], onset=0.2))
        self.check(self.step(0.1), 0.8, 0.4)
        self.check(self.step(2), 0.6, 0)

    def test_blendshapes_of_a_phone(self):
        self.send("blendshapes", Blendshapes(name=["browInnerUp", "browOuterUpLeft", "tongueOut"], weight=[0.5, 0.25, 1]))
        self.check(self.step(0.1), 0.45, 0.3)
        wait(lambda: self.lacking, "a word on blendshapes that the face lacks")
        self.send("blendshapes", Blendshapes(name=["tongueOut"], weight=[1]))
        self.send("blendshapes", Blendshapes(name=["browInnerUp", "browOuterUpLeft"], weight=[1, 1]))
        self.check(self.step(0.1), 1, 0.6)
        self.assertEqual(len(self.lacking), 1)

    def tip(self):
        """Height of the tip at the latest frame [m]."""
        self.face.wait_for_frame(lambda: True, "the landmarks")
        return self.face.height("tip")

    def test_action_units_and_their_halves(self):
        rest = self.tip()
        self.send("action_units", ActionUnits(name=["AU1", "AU1_left"], intensity=[0.5, 0.25]))
        self.check(self.step(0.1), 0.375, 0.25)
        # action units that a message does not name are at 0; AU27 shifts the bone
        self.send("action_units", ActionUnits(name=["AU27"], intensity=[0.5]))
        self.check(self.step(2), 0, 0)
        self.assertAlmostEqual(self.tip() - rest, 0.002, 4)

    def test_expression_moves_bones_and_gives_them_back(self):
        rest = self.tip()
        self.send("expression", Expression(name=["drop", "wink"], onset=0.5, hold=2, release=0.5))
        self.check(self.step(0.25), 0.3, 0)
        self.send("joint_states", JointState(name=[LEFT], position=[0]))
        self.check(self.step(2.2), 0, 0)
        self.assertAlmostEqual(self.tip() - rest, 0.002, 4)
        self.step(2.5)
        self.assertAlmostEqual(self.tip(), rest, 4)
        # another pose at full intensity moves the bone, and then a message for the bone alone does
        self.send("blendshapes", Blendshapes(name=["jawOpen"], weight=[1]))
        self.step(2)
        self.assertAlmostEqual(self.tip() - rest, 0.004, 4)
        pose = TransformStamped(child_frame_id="skull")
        pose.transform.rotation.w = 1
        pose.transform.translation.x = 0.001
        self.send("bone_pose", pose)
        self.step(2)
        self.assertAlmostEqual(self.tip(), rest, 4)
        # from where that message has moved it, a further pose takes the bone to rest over its onset
        pose.transform.translation.x, pose.transform.translation.z = 0, 0.004
        self.send("bone_pose", pose)
        self.step(2)
        self.assertAlmostEqual(self.tip() - rest, 0.004, 4)
        self.send("expression", Expression(name=["relax"], onset=1))
        self.step(0.5)
        self.assertAlmostEqual(self.tip() - rest, 0.002, 3)
        self.step(2)
        self.assertAlmostEqual(self.tip(), rest, 4)

    def test_watchdog_relaxes_a_face_without_controller(self):
        self.config.update_configuration({"command_timeout": 0.4, "relax_time": 0.2})
        self.send("muscle_activation", MuscleActivation(name=[LEFT, RIGHT], activation=[0.8, 0.4]))
        self.check(self.step(0.3), 0.8, 0.4)
        self.send("joint_states", JointState(name=[LEFT], position=[0.6]))
        self.check(self.step(0.3), 0.6, 0.4)
        self.check(self.step(0.2), 0.3, 0.2)
        wait(lambda: "no command" in self.face.diagnostics[0].message, "a diagnostic")
        self.assertEqual(self.face.diagnostics[0].level, 1)
        self.check(self.step(0.5), 0, 0)
        # a controller that starts again commands the face at once
        self.send("muscle_activation", MuscleActivation(name=[LEFT], activation=[0.8]))
        self.check(self.step(0.1), 0.8, 0)
        wait(lambda: "no command" not in self.face.diagnostics[0].message, "the end of the diagnostic")
        # a trajectory counts as a command until its end
        self.send("joint_trajectory", trajectory([RIGHT], (1, (1,))))
        self.check(self.step(1), 0.8, 1)
        self.check(self.step(0.5), 0.4, 0.5)
        wait(lambda: "no command" in self.face.diagnostics[0].message, "a diagnostic")
        self.config.update_configuration({"command_timeout": 0})
        wait(lambda: "no command" not in self.face.diagnostics[0].message, "the end of the diagnostic")

    def test_numbers_that_are_not_finite_do_not_configure(self):
        for name in ("frame_rate", "colour_range", "damping", "relax_time", "command_timeout", "stamp_tolerance", "real_time_factor_warning"):
            before = self.config.get_configuration()[name]
            self.assertEqual(self.config.update_configuration({name: math.nan})[name], before)

    def test_stamps_that_are_stale_or_of_the_future_are_refused(self):
        self.config.update_configuration({"stamp_tolerance": 60})
        for shift in (-1000, 1000):
            message = MuscleActivation(name=[LEFT], activation=[0.9])
            message.header.stamp = rospy.Time.now() + rospy.Duration(shift)
            self.send_in_vain("muscle_activation", message)
            self.assertIn("old" if shift < 0 else "in the future",
                          self.face.diagnostic("latest refusal on ~muscle_activation"))
        message.header.stamp = rospy.Time.now()
        self.send("muscle_activation", message)
        self.check(self.step(0.1), 0.9, 0)
        # trajectories that begin in an hour, and those that are over, are refused
        later = trajectory([LEFT], (0, (0.1,)))
        for shift in (-3600, 3600):
            later.header.stamp = rospy.Time.now() + rospy.Duration(shift)
            self.send_in_vain("joint_trajectory", later)
        self.check(self.step(0.1), 0.9, 0)

    def test_malformed_messages_are_refused_and_a_series_is_told_once(self):
        self.send("muscle_activation", MuscleActivation(name=[LEFT], activation=[0.25]))
        nan, point = math.nan, JointTrajectoryPoint
        many = ["nobody%d" % i for i in range(1000000)]
        in_millimetres = TransformStamped(child_frame_id="skull")
        in_millimetres.transform.rotation.w = 1
        in_millimetres.transform.translation.z = -20
        bad = {
            "muscle_activation": [
                MuscleActivation(name=[LEFT], activation=[]),
                MuscleActivation(name=[], activation=[0.5]),
                MuscleActivation(name=[LEFT], activation=[nan]),
                MuscleActivation(name=[LEFT, LEFT], activation=[0.1, 0.2]),
                MuscleActivation(name=[LEFT, "n" * 100000], activation=[0.5, 0.5]),
                MuscleActivation(name=many, activation=[0.5] * len(many)),
            ],
            "joint_states": [JointState(name=[LEFT], velocity=[1]), JointState(name=[LEFT], position=[-1e-9])],
            "joint_trajectory": [
                trajectory([LEFT], (0.1, (2,))),
                trajectory([LEFT], (0.1, (nan,))),
                trajectory([LEFT], (0.1, (0.5, 0.5))),
                trajectory([LEFT], (0.2, (0.5,)), (0.1, (0.5,))),
                trajectory([LEFT], (-1, (0.5,))),
                trajectory(["nobody"], (0.1, (0.5,))),
                trajectory([LEFT, LEFT], (0.1, (0.5, 0.5))),
                JointTrajectory(joint_names=[LEFT], points=[point()]),
                trajectory(many[:10]),
            ],
            "blendshapes": [
                Blendshapes(name=["browInnerUp"], weight=[1.5]),
                Blendshapes(name=["browInnerUp"], weight=[nan]),
                Blendshapes(name=["eyebrowsUp"], weight=[0.5]),
                Blendshapes(name=["browInnerUp"] * 2, weight=[0.5] * 2),
                Blendshapes(name=["browInnerUp"], weight=[]),
            ],
            "action_units": [
                ActionUnits(name=["AU1"], intensity=[1.5]),
                ActionUnits(name=["AU1"], intensity=[nan]),
                ActionUnits(name=["AU99"], intensity=[0.5]),
                ActionUnits(name=["AU1", "AU1"], intensity=[0.1, 0.1]),
                ActionUnits(name=many, intensity=[0.5] * len(many)),
            ],
            "expression": [
                Expression(name=["astonish"]),
                Expression(name=["raise"], intensity=[nan]),
                Expression(name=["raise"], intensity=[0.5, 0.5]),
                Expression(name=["raise"], onset=-1),
                Expression(name=["raise"], hold=math.inf),
                Expression(name=["raise"] * 100),
                Expression(name=["raise"] * 2),
            ],
            "bone_pose": [TransformStamped(child_frame_id="jaw"), in_millimetres],
        }
        for topic, messages in bad.items():
            self.wait_for_diagnostics()
            before, begin = self.refused(topic), time.monotonic()
            del self.warnings[:]
            for message in messages:
                self.topics[topic].publish(message)
            wait(lambda t=topic, n=before + len(messages): self.refused(t) == n, "refusals on ~" + topic)
            wait(lambda t=topic: any(t in text for text in self.warnings), "a warning on ~" + topic)
            # the first, and at most one per second for other reasons
            self.assertLessEqual(len([text for text in self.warnings if topic in text]), 2 + time.monotonic() - begin)
        self.assertIn("translations are in metres", self.face.diagnostic("latest refusal on ~bone_pose"))
        time.sleep(1.1)
        self.send_in_vain("expression", Expression(name=["frwon"]))
        wait(lambda: any("frwon" in text for text in self.warnings), "a warning of another reason")
        self.check(self.step(0.3), 0.25, 0)
        self.assertFalse(self.face.state.failed)
        self.send("muscle_activation", MuscleActivation(name=[LEFT], activation=[0.5]))
        self.check(self.step(0.1), 0.5, 0)


if __name__ == "__main__":
    rospy.init_node("inputs_test")
    rostest.rosrun("frontalis", "inputs", Inputs)
