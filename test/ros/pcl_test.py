#!/usr/bin/python3
"""Nodelets of PCL, as Debian has them, read positions, normals, intensity and packed colours of ~skin_points."""

import glob
import os
import struct
import subprocess
import tempfile
import unittest

import roslib.packages
import rospy
import rostest
from sensor_msgs.msg import PointCloud2

from face import Face, wait

FIELDS = ("x", "y", "z", "normal_x", "normal_y", "normal_z", "intensity", "rgb")
# Debian has the description of the package pcl_ros in libpcl-ros-dev, which needs 770 MB of other packages. Its nodelets alone
# (libpcl-ros-filters0d) need 33 MB.
DESCRIPTION = """<package format="2"><name>pcl_ros</name><version>1.0.0</version><description/><license>BSD</license>
<maintainer email="none@example.org">none</maintainer><depend>nodelet</depend>
<export><nodelet plugin="${prefix}/nodelets.xml"/></export></package>"""
TOPICS = ("/face/skin_points", "/forward/output", "/mean/output")


def points(cloud):
    """The points of a cloud as dictionaries of its fields; rgb as the triple that PCL has packed into a float."""
    offsets = {field.name: field.offset for field in cloud.fields}
    found = []
    for begin in range(0, len(cloud.data), cloud.point_step):
        point = {name: struct.unpack_from("<f", cloud.data, begin + offsets[name])[0] for name in FIELDS}
        packed = struct.unpack_from("<I", cloud.data, begin + offsets["rgb"])[0]
        point["rgb"] = [packed >> shift & 255 for shift in (16, 8, 0)]
        found.append(point)
    return found


def octant(point):
    return tuple(point[axis] >= 0 for axis in "xyz")


class Pcl(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        libraries = glob.glob("/usr/lib/*/libpcl_ros_filters.so.*")
        self.assertTrue(libraries, "the nodelets of PCL are missing: apt-get install libpcl-ros-filters0d")
        os.mkdir(folder.name + "/lib")
        os.symlink("/usr/share/pcl_ros/plugins/nodelet/libpcl_ros_filters.xml", folder.name + "/nodelets.xml")
        os.symlink(libraries[0], folder.name + "/lib/libpcl_ros_filters.so")
        with open(folder.name + "/package.xml", "w", encoding="ascii") as file:
            file.write(DESCRIPTION)
        self.environment = dict(os.environ, ROS_PACKAGE_PATH=folder.name + ":" + os.environ["ROS_PACKAGE_PATH"])

    def start(self, name, kind, *parameters):
        """Starts a nodelet of PCL that reads the skin of the face."""
        program = roslib.packages.find_node("nodelet", "nodelet")[0]
        process = subprocess.Popen([program, "standalone", kind, "__name:=" + name, "~input:=/face/skin_points", *parameters],
                                   env=self.environment)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)

    def test_filters_read_what_the_face_sends(self):
        self.start("forward", "pcl/PassThrough", "_filter_field_name:=normal_x", "_filter_limit_min:=0", "_filter_limit_max:=1.5")
        # The voxels meet at the origin of the face frame and are larger than the face: one point is left in each octant.
        self.start("mean", "pcl/VoxelGrid", "_leaf_size:=1.0", "_filter_limit_min:=-1.0")
        face, clouds = Face(), {}
        face.wait_until_ready()
        face.command(frontalis_left=0.9, frontalis_right=0)
        wait(lambda: face.target()["frontalis_left"] > 0.89, "the command")
        self.assertTrue(face.step(0.5).success)
        wait(lambda: face.state.time > 0.4, "the state")
        # The face stands still and repeats its frame, so that all clouds from now on show the same points.
        for topic in TOPICS:
            rospy.Subscriber(topic, PointCloud2, lambda cloud, topic=topic: clouds.update({topic: cloud}))
        wait(lambda: len(clouds) == len(TOPICS), "clouds")
        sent, forward, mean = (clouds[topic] for topic in TOPICS)
        for cloud in (forward, mean):
            self.assertEqual(cloud.header.frame_id, "face")
        skin = points(sent)
        self.assertGreater(max(point["intensity"] for point in skin), 1e-3)
        self.assertGreater(len({tuple(point["rgb"]) for point in skin}), 1)

        expected = [point for point in skin if point["normal_x"] >= 0]
        self.assertGreater(len(expected), 2)
        self.assertLess(len(expected), len(skin))
        self.assertEqual(points(forward), expected)

        octants = {}
        for point in skin:
            octants.setdefault(octant(point), []).append(point)
        self.assertLess(len(octants), len(skin))
        means = points(mean)
        self.assertEqual({octant(point) for point in means}, set(octants))
        self.assertEqual(len(means), len(octants))
        for point in means:
            of = octants[octant(point)]
            for name in FIELDS[:-1]:
                self.assertAlmostEqual(point[name], sum(other[name] for other in of) / len(of), delta=1e-5, msg=name)
            for channel, value in enumerate(point["rgb"]):
                self.assertAlmostEqual(value, sum(other["rgb"][channel] for other in of) / len(of), delta=1)


if __name__ == "__main__":
    rospy.init_node("pcl_test")
    rostest.rosrun("frontalis", "pcl", Pcl)
