#!/usr/bin/python3
"""What only heads publish: their eyeballs, and the 68 standard landmarks. The face frame hangs below a frame of another name."""

import math
import unittest

import rospy
import rostest
import tf2_ros
from geometry_msgs.msg import PoseArray, TransformStamped
from visualization_msgs.msg import Marker, MarkerArray

from face import LIMIT, Face, wait


class Parts(unittest.TestCase):
    def setUp(self):
        self.face = Face()
        self.latest = {}
        for topic, kind in (("eyes", MarkerArray), ("landmarks_68", PoseArray)):
            rospy.Subscriber("/face/" + topic, kind, lambda message, topic=topic: self.latest.update({topic: message}))

    def test_are_published(self):
        self.face.wait_until_ready()
        self.assertTrue(self.face.step(0.01).success)
        wait(lambda: len(self.latest) == 2 and self.latest["landmarks_68"].header.stamp == self.face.landmarks.header.stamp,
             "messages of the same frame")
        names = ["ibug_%d" % (n + 1) for n in range(68)]
        places = dict(zip(self.face.state.landmark, self.face.landmarks.poses))
        self.assertEqual(self.latest["landmarks_68"].poses, [places[name] for name in names])

        ball, iris = self.latest["eyes"].markers
        self.assertEqual((ball.ns, ball.type), ("eye_left", Marker.SPHERE))
        self.assertAlmostEqual(ball.scale.x, 0.024, 4)
        self.assertAlmostEqual(ball.pose.position.z, -0.022, 4)
        front = max(point.x for point in iris.points)
        self.assertAlmostEqual(front, 0.012, 3)

        # the eye turns to the face's left
        half = math.radians(10)
        pose = TransformStamped(child_frame_id="eye_left")
        pose.transform.rotation.z, pose.transform.rotation.w = math.sin(half), math.cos(half)
        # the pose turns about the origin of the face frame, which the middle of the eye is below
        poses = rospy.Publisher("/face/bone_pose", TransformStamped, queue_size=1)
        wait(poses.get_num_connections, "a connection")
        poses.publish(pose)

        def turned():
            self.assertTrue(self.face.step(0.1).success)
            points = self.latest["eyes"].markers[1].points
            return sum(point.y for point in points) / len(points) > 0.8 * 0.012 * math.sin(2 * half)

        wait(turned, "an iris that looks to the left")
        frames = tf2_ros.Buffer()
        listener = tf2_ros.TransformListener(frames)
        eye = frames.lookup_transform("neck", "face/bone/eye_left", rospy.Time(0), rospy.Duration(LIMIT)).transform
        self.assertAlmostEqual(eye.translation.z, -0.022, 4)
        listener.unregister()


if __name__ == "__main__":
    rospy.init_node("parts_test")
    rostest.rosrun("frontalis", "parts", Parts)
