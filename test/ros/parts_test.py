#!/usr/bin/python3
"""What only heads publish: their eyeballs, and the 68 standard landmarks. The face frame hangs below a frame of another name."""

import math
import unittest

import rospy
import rostest
import tf2_ros
from geometry_msgs.msg import Point, PoseArray, TransformStamped
from visualization_msgs.msg import Marker, MarkerArray

from face import LIMIT, Face, wait


class Parts(unittest.TestCase):
    def setUp(self):
        self.face = Face()
        self.latest = {}
        for topic, kind in (("eyes", MarkerArray), ("landmarks_68", PoseArray)):
            rospy.Subscriber("/face/" + topic, kind, lambda message, topic=topic: self.latest.update({topic: message}))
        self.frames = tf2_ros.Buffer()
        self.listener = tf2_ros.TransformListener(self.frames)

    def place(self, marker, points):
        """The middle of points of a marker, in the parent frame of the face."""
        def moved(point, translation, q):
            """A point turned by a unit quaternion and shifted."""
            x, y, z = point
            # twice the cross product of the quaternion's vector and the point
            cross = 2 * (q.y * z - q.z * y), 2 * (q.z * x - q.x * z), 2 * (q.x * y - q.y * x)
            return (x + q.w * cross[0] + q.y * cross[2] - q.z * cross[1] + translation.x,
                    y + q.w * cross[1] + q.z * cross[0] - q.x * cross[2] + translation.y,
                    z + q.w * cross[2] + q.x * cross[1] - q.y * cross[0] + translation.z)

        frame = self.frames.lookup_transform("neck", marker.header.frame_id, rospy.Time(0), rospy.Duration(LIMIT)).transform
        middle = [sum(getattr(p, axis) for p in points) / len(points) for axis in "xyz"]
        return moved(moved(middle, marker.pose.position, marker.pose.orientation), frame.translation, frame.rotation)

    def test_are_published(self):
        self.face.wait_until_ready()
        self.assertTrue(self.face.step(0.01).success)
        wait(lambda: len(self.latest) == 2 and self.latest["landmarks_68"].header.stamp == self.face.landmarks.header.stamp,
             "messages of the same frame")
        places = dict(zip(self.face.state.landmark, self.face.landmarks.poses))
        self.assertEqual(self.latest["landmarks_68"].poses, [places["ibug_%d" % (n + 1)] for n in range(68)])

        ball, iris = self.latest["eyes"].markers
        self.assertEqual((ball.ns, ball.type), ("eye_left", Marker.SPHERE))
        self.assertAlmostEqual(ball.scale.x, 0.024, 4)
        middle = self.place(ball, [Point()])
        self.assertAlmostEqual(middle[2], -0.022, 4)
        looks = [a - b for a, b in zip(self.place(iris, iris.points), middle)]
        self.assertAlmostEqual(looks[0], 0.0115, delta=1e-3)
        self.assertAlmostEqual(looks[1], 0, 4)

        # the eye turns to the face's left by 20 degrees, about the vertical axis of the face frame, which goes through it
        half = math.radians(10)
        pose = TransformStamped(child_frame_id="eye_left")
        pose.transform.rotation.z, pose.transform.rotation.w = math.sin(half), math.cos(half)
        poses = rospy.Publisher("/face/bone_pose", TransformStamped, queue_size=1)
        wait(poses.get_num_connections, "a connection")
        poses.publish(pose)

        def turned():
            self.assertTrue(self.face.step(0.1).success)
            ball, iris = self.latest["eyes"].markers
            return self.place(iris, iris.points)[1] > 0.8 * looks[0] * math.sin(2 * half)

        wait(turned, "an iris that looks to the left")


if __name__ == "__main__":
    rospy.init_node("parts_test")
    rostest.rosrun("frontalis", "parts", Parts)
