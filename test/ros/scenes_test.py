#!/usr/bin/python3
"""A face that is replaced while it runs, its live configuration, the probe, and the markers of its muscles."""

import math
import os
import struct
import unittest

import rospkg
import rospy
import rostest
import tf2_ros
from dynamic_reconfigure.client import Client
from frontalis.srv import LoadScene, Probe
from geometry_msgs.msg import Point, TransformStamped
from sensor_msgs.msg import PointCloud2
from visualization_msgs.msg import Marker, MarkerArray

from face import LIMIT, Face, wait

FOLDER = os.path.join(rospkg.RosPack().get_path("frontalis"), "test")


def link(child, lift):
    message = TransformStamped(child_frame_id=child)
    message.header.frame_id = "face"
    message.header.stamp = rospy.Time.now()
    message.transform.translation.z = lift
    message.transform.rotation.w = 1
    return message


class Scenes(unittest.TestCase):
    def setUp(self):
        self.face = Face()
        self.face.wait_until_ready()
        self.assertTrue(self.face.pause(True).success)
        self.assertTrue(self.face.reset().success)
        self.face.wait_for_frame(lambda: self.face.state.time == 0, "the reset")
        self.assertTrue(self.face.pause(False).success)
        self.load = rospy.ServiceProxy("/face/load_scene", LoadScene)

    def test_1_a_bad_scene_changes_nothing(self):
        self.face.command(frontalis_left=0.5)
        wait(lambda: abs(self.face.state.activation[0] - 0.5) < 1e-3, "the command")
        time = self.face.state.time
        for scene, why in (("nowhere.yaml", "nowhere.yaml"), ("", "found nothing"), (FOLDER + "/scene/five_faults.yaml", "five_faults"),
                           (FOLDER + "/ros/pair.vtkhdf", "pair.vtkhdf")):
            answer = self.load(scene=scene)
            self.assertFalse(answer.success)
            self.assertIn(why, answer.message)
        wait(lambda: self.face.state.time > time + 0.1, "the old face, which goes on")
        self.assertEqual(self.face.state.name, ["frontalis_left", "frontalis_right"])
        self.assertAlmostEqual(self.face.state.activation[0], 0.5, 3)

    def test_2_another_scene_takes_over(self):
        muscles = []
        rospy.Subscriber("/face/muscles", MarkerArray, lambda message: muscles.extend(message.markers))
        wait(lambda: any(marker.ns == "frontalis_left" for marker in muscles), "the muscles")
        answer = self.load(scene=FOLDER + "/ros/small.yaml")
        self.assertTrue(answer.success, answer.message)
        wait(lambda: self.face.state.name == ["lift"], "the new face")
        wait(lambda: {m.ns for m in muscles if m.action == Marker.DELETE} == {"frontalis_left", "frontalis_right"},
             "the removal of the former muscles")
        self.face.command(lift=0.3)
        wait(lambda: abs(self.face.state.activation[0] - 0.3) < 1e-3, "a command to the new face")
        self.assertTrue(self.load(scene=FOLDER + "/ros/pair.yaml").success)
        wait(lambda: len(self.face.state.name) == 2 and len(self.face.landmarks.poses) == 1, "the first face again")
        self.assertEqual(self.face.target(), {"frontalis_left": 0, "frontalis_right": 0})

    def test_3_configuration_changes_while_it_runs(self):
        config = Client("/face", timeout=LIMIT)
        markers = []
        listener = rospy.Subscriber("/face/skin", Marker, markers.append)
        wait(lambda: markers, "a marker")
        colour = markers[-1].colors[0]
        config.update_configuration({"skin_colour": "displacement", "frame_rate": 10, "effects_off": "contraction"})
        # without displacement the colour is the blue end of the scale, whereas skin is reddish
        self.assertGreater(colour.r, colour.b)
        wait(lambda: markers[-1].colors[0].b > markers[-1].colors[0].r, "false colours")
        running = self.face.switch_effect("", False)
        self.assertFalse(dict(zip(running.name, running.running))["contraction"])
        # a configuration that cannot be applied is refused as a whole
        self.assertEqual(config.update_configuration({"effects_off": "magic"})["effects_off"], "contraction")
        config.update_configuration({"skin_colour": "skin", "effects_off": "", "frame_rate": 0})
        wait(lambda: markers[-1].colors[0].r > markers[-1].colors[0].b, "the colours of skin")
        running = self.face.switch_effect("", False)
        self.assertTrue(dict(zip(running.name, running.running))["contraction"])
        listener.unregister()

    def test_3_fields_colours_and_limits_change_while_it_runs(self):
        config = Client("/face", timeout=LIMIT)
        clouds, markers = [], []
        rospy.Subscriber("/face/skin_field", PointCloud2, clouds.append)
        rospy.Subscriber("/face/skin", Marker, markers.append)
        self.face.command(frontalis_left=0.9, frontalis_right=0)

        def largest():
            return max(struct.unpack_from("<7f", clouds[-1].data, v * clouds[-1].point_step)[6] for v in range(clouds[-1].width))

        config.update_configuration({"skin_field": "stress"})
        wait(lambda: clouds and largest() > 1e3, "stress [Pa]")
        config.update_configuration({"skin_field": "strain"})
        wait(lambda: 0.02 < largest() < 1, "strain")
        # one half of the bar is coloured like full contraction, the other like none
        config.update_configuration({"skin_colour": "activation"})
        wait(lambda: {c.r > 1.3 * c.b for c in markers[-1].colors} == {True, False}, "red and blue")
        config.update_configuration({"colour_range": 100})
        wait(lambda: all(c.b > c.r for c in markers[-1].colors), "blue alone")
        config.update_configuration({"skin_colour": "skin", "colour_range": 0, "real_time_factor_warning": 1000})
        wait(lambda: "too slow" in self.face.diagnostics[0].message, "a warning")
        config.update_configuration({"real_time_factor_warning": 0})
        wait(lambda: "too slow" not in self.face.diagnostics[0].message, "the end of the warning")

    def test_3_damping_changes_while_it_runs(self):
        config = Client("/face", timeout=LIMIT)
        rest = self.face.height("tip")
        self.addCleanup(config.update_configuration, {"damping": -1})
        config.update_configuration({"damping": 1e9})
        self.face.command(frontalis_left=0.9, frontalis_right=0.9)
        wait(lambda: min(self.face.state.activation) > 0.89, "the command")
        begin = self.face.state.time
        wait(lambda: self.face.state.time > begin + 0.1, "a tenth of a second")
        self.assertLess(self.face.height("tip") - rest, 5e-4)
        config.update_configuration({"damping": -1})
        wait(lambda: self.face.height("tip") - rest > 1e-3, "the tip a millimetre up")

    def test_4_probe_reads_the_skin(self):
        probe = rospy.ServiceProxy("/face/probe", Probe)
        answer = probe(Point(0, 0, -0.02))
        self.assertTrue(answer.success, answer.message)
        self.assertLess(answer.distance, 0.01)
        self.assertLess(answer.position.z, -0.01)
        normal = answer.normal
        self.assertAlmostEqual(math.hypot(normal.x, normal.y, normal.z), 1, 4)
        self.assertFalse(probe(Point(math.nan, 0, 0)).success)

    def test_5_muscles_are_lines_coloured_by_activation(self):
        shown = []
        rospy.Subscriber("/face/muscles", MarkerArray, shown.append)
        self.face.command(frontalis_left=0.9, frontalis_right=0)

        def coloured():
            colours = {marker.ns: marker.color for marker in shown[-1].markers} if shown else {}
            return colours and colours["frontalis_left"].r > colours["frontalis_left"].b

        wait(coloured, "a red muscle")
        for marker in shown[-1].markers:
            self.assertEqual(marker.header.frame_id, "face")
            self.assertGreater(len(marker.points), 1)
            self.assertEqual(len(marker.points) % 2, 0)
            for point in marker.points:
                self.assertLess(abs(point.z), 0.02)

    def test_6_cost_is_in_the_diagnostics(self):
        wait(lambda: float(self.face.diagnostic("wall time per step [us]") or 0) > 0, "the time per step")
        wait(lambda: float(self.face.diagnostic("memory of the solver [MB]") or 0) > 0, "the memory")
        # the solver's own words, which name the device and how it is used (test/solver/backend_test.cpp)
        self.assertTrue(self.face.diagnostic("backend"))
        self.assertEqual(self.face.diagnostic("backend"), self.face.state.backend)

    def test_7_bones_follow_frames_at_once_after_a_reset(self):
        rospy.set_param("/face/bone_frames", {"skull": {"frame": "jaw", "rest": "jaw_rest"}})
        self.addCleanup(rospy.delete_param, "/face/bone_frames")
        frames, fixed = tf2_ros.TransformBroadcaster(), tf2_ros.StaticTransformBroadcaster()
        fixed.sendTransform(link("jaw_rest", 0))
        self.assertTrue(self.load(scene=FOLDER + "/ros/moved.yaml").success)
        self.face.wait_for_frame(lambda: not self.face.state.name and self.face.state.time > 0, "the face with a bone")
        rest = self.face.height("tip")

        def lifted(lift):
            frames.sendTransform(link("jaw", lift))
            return abs(self.face.height("tip") - rest - lift) < 2e-4

        for _ in range(3):
            # The bone must not wait for the time that the face had reached before.
            self.assertTrue(self.face.step(2 * LIMIT).success)
            self.assertTrue(self.face.pause(False).success)
            self.assertTrue(self.face.reset().success)
            wait(lambda: lifted(0), "the bone at rest")
            wait(lambda: lifted(0.003), "the bone above it")
            self.assertLess(self.face.state.time, 2 * LIMIT)


if __name__ == "__main__":
    rospy.init_node("scenes_test")
    rostest.rosrun("frontalis", "scenes", Scenes)
