#!/usr/bin/python3
"""Services, inputs, topics and frames of a face. It runs a small scene in lock-step, so that every number is exact."""

import math
import struct
import threading
import unittest

import rospy
import rostest
import tf2_ros
from sensor_msgs.msg import JointState, PointCloud2
from shape_msgs.msg import Mesh
from visualization_msgs.msg import Marker

from face import LIMIT, Face, wait


class Services(unittest.TestCase):
    def setUp(self):
        self.face = Face()
        self.face.wait_until_ready()
        self.assertTrue(self.face.reset().success)
        self.face.wait_for_frame(lambda: self.face.state.time == 0 and self.face.target() == {"lift": 0}, "the reset")

    def test_list_muscles_names_muscles_and_expressions(self):
        answer = self.face.list_muscles()
        self.assertTrue(answer.success)
        self.assertEqual(answer.name, ["lift"])
        self.assertEqual(answer.activation, (0,))
        self.assertEqual(answer.target, (0,))
        self.assertEqual(sorted(answer.expressions), ["relax", "shorten"])

    def test_step_advances_by_exactly_so_many_seconds(self):
        first = self.face.step(0.05)
        self.assertTrue(first.success, first.message)
        self.assertAlmostEqual(first.time, 0.05, 9)
        self.assertAlmostEqual(self.face.step(0.1).time, 0.15, 9)
        wait(lambda: abs(self.face.state.time - 0.15) < 1e-9, "the state at 0.15 s")
        self.face.wait_for_states(2)
        self.assertAlmostEqual(self.face.state.time, 0.15, 9)

    def test_step_refuses_what_is_no_time(self):
        for seconds in (0, -1, math.nan, math.inf):
            answer = self.face.step(seconds)
            self.assertFalse(answer.success)
            self.assertIn("seconds", answer.message)
        self.assertEqual(self.face.state.time, 0)

    def test_muscle_lifts_the_tip_and_reset_brings_it_back(self):
        rest = self.face.height("tip")
        self.face.command(lift=0.75)
        wait(lambda: self.face.target() == {"lift": 0.75}, "the command")
        self.assertTrue(self.face.step(0.5).success)
        wait(lambda: self.face.state.time > 0.4, "the state")
        wait(lambda: self.face.height("tip") - rest > 1e-3, "the tip a millimetre up")
        self.assertEqual(self.face.state.activation, (0.75,))
        self.assertEqual(self.face.state.name, ["lift"])
        self.assertGreater(self.face.state.internal_energy, 0)
        self.assertTrue(self.face.reset().success)
        wait(lambda: self.face.state.time == 0, "the reset")
        wait(lambda: abs(self.face.height("tip") - rest) < 1e-9, "the tip at rest")
        self.assertEqual(self.face.target(), {"lift": 0})

    def test_joint_states_and_expression_command_too(self):
        joints = rospy.Publisher("/face/joint_states", JointState, queue_size=10)
        wait(joints.get_num_connections, "a connection")
        joints.publish(JointState(name=["lift"], position=[0.25]))
        wait(lambda: self.face.target() == {"lift": 0.25}, "the joint state")
        self.face.express("shorten")
        wait(lambda: self.face.target() == {"lift": 0.5}, "the expression")
        self.face.express("relax")
        wait(lambda: self.face.target() == {"lift": 0}, "the relaxation")

    def test_effects_go_off_and_on_again(self):
        effects = self.face.switch_effect("", False)
        self.assertTrue(effects.success, effects.message)
        self.assertEqual(effects.name, ["elasticity", "contraction", "rigid_nodes", "output_fields"])
        self.assertTrue(all(effects.running))
        rest = self.face.height("tip")
        off = self.face.switch_effect("contraction", False)
        self.assertTrue(off.success, off.message)
        self.assertEqual(dict(zip(off.name, off.running))["contraction"], False)
        wait(lambda: self.face.diagnostic("effects switched off") == "contraction", "the diagnostics")
        self.face.command(lift=0.75)
        wait(lambda: self.face.target() == {"lift": 0.75}, "the command")
        self.assertTrue(self.face.step(0.3).success)
        wait(lambda: self.face.state.time > 0.25, "the state")
        wait(lambda: abs(self.face.height("tip") - rest) < 1e-6, "a tip that stays")
        self.assertTrue(self.face.switch_effect("contraction", True).success)
        self.assertTrue(self.face.step(0.3).success)
        wait(lambda: self.face.height("tip") - rest > 1e-3, "the tip a millimetre up")

    def test_a_long_step_keeps_nobody_waiting(self):
        answers = []

        def take_a_long_step():
            while not answers or "another step" in answers[-1].message:
                answers.append(self.face.step(1e6))

        stepping = threading.Thread(target=take_a_long_step)
        stepping.start()
        wait(lambda: "another step" in self.face.step(1e-9).message, "the step under way")
        self.assertTrue(self.face.switch_effect("contraction", False).success)
        self.assertTrue(self.face.list_muscles().success)
        self.assertTrue(self.face.switch_effect("contraction", True).success)
        self.assertTrue(self.face.reset().success)
        stepping.join()
        self.assertIn("ended early", answers[-1].message)

    def test_effects_that_cannot_be_switched_say_why(self):
        for effect, why in (("magic", "the effects are elasticity"), ("viscosity", "the model has no viscosity"),
                            ("elasticity", "cannot be switched while running")):
            answer = self.face.switch_effect(effect, False)
            self.assertFalse(answer.success)
            self.assertIn(why, answer.message)
            self.assertTrue(all(answer.running))

    def test_strain_of_the_skin_is_shown_to_those_who_ask(self):
        self.face.command(lift=0.75)
        wait(lambda: self.face.target() == {"lift": 0.75}, "the command")
        clouds = []
        listener = rospy.Subscriber("/face/skin_field", PointCloud2, clouds.append)
        wait(lambda: listener.get_num_connections() > 0, "a connection")
        self.assertTrue(self.face.step(0.5).success)
        # rospy counts a connection before it stands
        wait(lambda: self.face.step(0.02).success and clouds, "a field")
        listener.unregister()
        cloud = clouds[-1]
        strain = [struct.unpack_from("<7f", cloud.data, v * cloud.point_step)[6] for v in range(cloud.width)]
        # the bar shortens along its fibres and widens across them
        self.assertGreater(max(strain), 0.02)
        self.assertLess(max(strain), 0.5)

    def test_bad_messages_leave_the_state_untouched(self):
        self.face.command(lift=0.4)
        wait(lambda: self.face.target() == {"lift": 0.4}, "the command")
        joints = rospy.Publisher("/face/joint_states", JointState, queue_size=1)
        wait(joints.get_num_connections, "a connection")
        for names, values in (
            (["lift"], []),
            (["lift"], [0.9, 0.9]),
            (["lift"], [math.nan]),
            (["lift"], [1.5]),
            (["lift"], [-0.1]),
            (["lift", "nobody"], [0.9, 0.1]),
            (["lift", "lift"], [0.8, 0.9]),
        ):
            self.face.send(names, values)
        joints.publish(JointState(name=["lift"], velocity=[0.9]))
        joints.publish(JointState(name=["lift"], position=[math.inf]))
        self.face.express("astonishment")
        rospy.sleep(1)  # time for the messages to arrive; if they take longer, the test passes without testing them
        self.assertEqual(self.face.target(), {"lift": 0.4})
        self.assertTrue(self.face.step(0.1).success)
        wait(lambda: self.face.state.time > 0.05, "the state")
        self.assertAlmostEqual(self.face.state.activation[0], 0.4, 6)
        self.assertFalse(self.face.state.failed)
        # after bad messages, good ones are still accepted
        self.face.command(lift=0.1)
        wait(lambda: self.face.target() == {"lift": 0.1}, "a good command after bad ones")

    def test_skin_messages_agree_with_each_other(self):
        mesh = rospy.wait_for_message("/face/skin_topology", Mesh, LIMIT)
        marker = rospy.wait_for_message("/face/skin", Marker, LIMIT)
        cloud = rospy.wait_for_message("/face/skin_points", PointCloud2, LIMIT)
        self.assertEqual(marker.header.frame_id, "face")
        self.assertEqual(cloud.header.frame_id, "face")
        self.assertEqual(cloud.width, len(mesh.vertices))
        self.assertEqual(cloud.width, self.face.state.skin_vertices)
        self.assertEqual(len(marker.points), 3 * len(mesh.triangles))
        self.assertEqual(len(marker.colors), len(marker.points))
        self.assertEqual([field.name for field in cloud.fields],
                         ["x", "y", "z", "normal_x", "normal_y", "normal_z", "intensity", "rgb"])
        corners = [index for triangle in mesh.triangles for index in triangle.vertex_indices]
        for point, vertex in zip(marker.points, corners):
            values = struct.unpack_from("<7f", cloud.data, vertex * cloud.point_step)
            rest = mesh.vertices[vertex]
            self.assertAlmostEqual(values[0], point.x, 6)
            self.assertAlmostEqual(values[2], point.z, 6)
            self.assertAlmostEqual(values[2], rest.z, 6)
            self.assertAlmostEqual(math.hypot(*values[3:6]), 1, 5)
            self.assertAlmostEqual(values[6], 0, 6)

    def test_landmark_is_a_frame_below_the_face(self):
        buffer = tf2_ros.Buffer()
        listener = tf2_ros.TransformListener(buffer)
        found = buffer.lookup_transform("map", "face/tip", rospy.Time(0), rospy.Duration(30))
        self.assertAlmostEqual(found.transform.translation.z, self.face.height("tip"), 9)
        listener.unregister()

    def test_diagnostics_are_well(self):
        wait(lambda: self.face.diagnostics and self.face.diagnostics[0].level == 0, "good diagnostics")
        self.assertIn("real-time factor", [pair.key for pair in self.face.diagnostics[0].values])


if __name__ == "__main__":
    rospy.init_node("services_test")
    rostest.rosrun("frontalis", "services", Services)
