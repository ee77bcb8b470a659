#!/usr/bin/python3
"""A virtual camera that sees a bar of tissue, a finger and an eye: its images, points and landmarks, as node and as nodelet."""

import math
import struct
import unittest

import rospy
import rostest
import sensor_msgs.point_cloud2
import tf2_ros
from geometry_msgs.msg import TransformStamped
from sensor_msgs.msg import CameraInfo, Image, PointCloud2
from visualization_msgs.msg import MarkerArray

from face import Face, wait

TOPICS = {"camera_info": CameraInfo, "rgb": Image, "depth": Image, "labels": Image, "points": PointCloud2,
          "landmarks": PointCloud2}
WIDTH, HEIGHT = 160, 120
EYE, BODY, SKIN = 2, 3, 4


class Camera(unittest.TestCase):
    def setUp(self):
        self.face = Face()
        self.face.wait_until_ready()
        self.assertTrue(self.face.reset().success)
        self.frames = tf2_ros.Buffer()
        self.listener = tf2_ros.TransformListener(self.frames)

    def listen(self, camera):
        """Subscribes to all topics of a camera. Their latest messages go to the dictionary that is returned."""
        latest = {}
        subscribers = [rospy.Subscriber("/%s/%s" % (camera, topic), kind, lambda message, topic=topic: latest.update({topic: message}))
                       for topic, kind in TOPICS.items()]
        wait(lambda: all(subscriber.get_num_connections() for subscriber in subscribers), "connections with " + camera)
        return latest

    def picture(self, latest, condition=lambda: True):
        """Steps until the camera has sent one picture of one moment, for which the condition holds."""
        def complete():
            self.assertTrue(self.face.step(0.02).success)
            rospy.sleep(0.1)
            return len(latest) == len(TOPICS) and len({m.header.stamp for m in latest.values()}) == 1 and condition()
        wait(complete, "a picture")
        return dict(latest)

    def test_images_points_and_landmarks_agree(self):
        shot = self.picture(self.listen("camera"))
        for message in shot.values():
            self.assertEqual(message.header.frame_id, "camera_optical_frame")
        for topic, encoding in (("rgb", "rgb8"), ("depth", "32FC1"), ("labels", "mono8")):
            self.assertEqual(shot[topic].encoding, encoding)
        for topic in ("camera_info", "rgb", "depth", "labels", "points"):
            self.assertEqual((shot[topic].width, shot[topic].height), (WIDTH, HEIGHT))
        k = shot["camera_info"].K
        self.assertAlmostEqual(2 * math.degrees(math.atan(WIDTH / 2 / k[0])), 24, places=9)
        self.assertEqual((k[2], k[5]), ((WIDTH - 1) / 2, (HEIGHT - 1) / 2))

        depth = struct.unpack("<%df" % (WIDTH * HEIGHT), shot["depth"].data)
        labels = shot["labels"].data
        names = rospy.get_param("/camera/label_names")
        self.assertEqual([names[0], names[BODY], names[SKIN]], ["background", "body", "skin"])
        self.assertGreater(labels.count(SKIN), 1000)
        self.assertGreater(labels.count(BODY), 1000)
        self.assertEqual([math.isnan(z) for z in depth], [label == 0 for label in labels])
        points = list(sensor_msgs.point_cloud2.read_points(shot["points"], field_names=("x", "y", "z")))
        for pixel in range(0, WIDTH * HEIGHT, 7):
            x, y, z = points[pixel]
            self.assertTrue(z == depth[pixel] or math.isnan(z) and math.isnan(depth[pixel]))
            if not math.isnan(z):
                self.assertAlmostEqual(k[2] + k[0] * x / z, pixel % WIDTH, delta=1e-3)
                self.assertAlmostEqual(k[5] + k[4] * y / z, pixel // WIDTH, delta=1e-3)

        # the bar is at rest: its front is the plane 5 mm before the middle
        self.frames.can_transform("face", "camera_optical_frame", rospy.Time(0), rospy.Duration(10))
        pose = self.frames.lookup_transform("face", "camera_optical_frame", rospy.Time(0)).transform
        at, q = pose.translation, pose.rotation
        self.assertAlmostEqual(at.x, 0.12, places=9)
        rows = {"front": None, "left": None, "behind": None}
        fields = ("x", "y", "z", "u", "v", "visible")
        for name, row in zip(self.face.state.landmark, sensor_msgs.point_cloud2.read_points(shot["landmarks"], fields)):
            rows[name] = row
        self.assertEqual([rows[name][5] for name in ("front", "left", "behind")], [1, 1, 0])
        for name in ("front", "left"):
            x, y, z, u, v, _ = rows[name]
            self.assertLess(math.hypot(k[2] + k[0] * x / z - u, k[5] + k[4] * y / z - v), 0.5)
            pixel = round(v) * WIDTH + round(u)
            self.assertEqual(labels[pixel], SKIN)
            self.assertAlmostEqual(depth[pixel], z, delta=5e-4)
        u, v = round(rows["front"][3]), round(rows["front"][4])
        ray = ((u - k[2]) / k[0], (v - k[5]) / k[4], 1)
        # the x axis of the face frame in that of the camera is the first row of the rotation
        forward = (1 - 2 * (q.y ** 2 + q.z ** 2), 2 * (q.x * q.y - q.w * q.z), 2 * (q.x * q.z + q.w * q.y))
        exact = (0.005 - at.x) / sum(a * b for a, b in zip(forward, ray))
        self.assertAlmostEqual(depth[v * WIDTH + u], exact, delta=1e-4)

    def test_camera_follows_the_moving_face_as_a_nodelet_too(self):
        first, second = self.listen("camera"), self.listen("second")
        before = self.picture(first)
        self.face.command(lift=1)
        wait(lambda: self.face.target()["lift"] == 1, "the command")

        def bottom(shot):
            """The lowest row of the picture with skin."""
            width = shot["labels"].width
            return max(pixel for pixel, label in enumerate(shot["labels"].data) if label == SKIN) // width
        after = self.picture(first, lambda: bottom(first) < bottom(before) - 2)
        self.assertGreater(after["labels"].header.stamp, before["labels"].header.stamp)
        shot = self.picture(second)
        self.assertEqual((shot["rgb"].width, shot["rgb"].height), (640, 480))
        self.assertGreater(shot["labels"].data.count(SKIN), 1000)

    def test_eye_is_sent_once_and_turns_with_its_bone(self):
        markers, first = [], self.listen("camera")
        rospy.Subscriber("/face/eyes", MarkerArray, markers.append)
        wait(lambda: markers, "the markers of the eye")

        def pupil(shot):
            """Number of pixels of the eye that are dark."""
            colours = shot["rgb"].data
            return sum(label == EYE and sum(colours[3 * pixel:3 * pixel + 3]) < 60 for pixel, label in enumerate(shot["labels"].data))
        ahead = self.picture(first)
        self.assertGreater(ahead["labels"].data.count(EYE), 300)
        self.assertGreater(pupil(ahead), 10)
        # the front of the ball on the line from the camera to its centre, 7 mm before the centre; the iris is at most 0.5 mm higher
        centre = self.frames.lookup_transform("camera_optical_frame", "face/bone/eye_left", rospy.Time(0), rospy.Duration(60)).transform.translation
        k = ahead["camera_info"].K
        pixel = round(k[5] + k[4] * centre.y / centre.z) * WIDTH + round(k[2] + k[0] * centre.x / centre.z)
        distance = math.sqrt(centre.x ** 2 + centre.y ** 2 + centre.z ** 2)
        depth = struct.unpack_from("<f", ahead["depth"].data, 4 * pixel)[0]
        self.assertAlmostEqual(depth, centre.z * (1 - 0.007 / distance), delta=5e-4)

        poses = rospy.Publisher("/face/bone_pose", TransformStamped, queue_size=1)
        wait(poses.get_num_connections, "a connection")
        aside = TransformStamped(child_frame_id="eye_left")
        # a quarter turn to the right about the centre of the eye, which is at (0, 16, 4) mm
        aside.transform.rotation.z, aside.transform.rotation.w = -math.sqrt(0.5), math.sqrt(0.5)
        aside.transform.translation.x, aside.transform.translation.y = -0.016, 0.016
        poses.publish(aside)
        after = self.picture(first, lambda: "rgb" in first and "labels" in first and pupil(first) == 0)
        self.assertGreater(after["labels"].data.count(EYE), 300)
        self.assertEqual(len(markers), 1)

    def test_camera_without_a_place_sends_nothing_and_the_others_go_on(self):
        lost, first, second = (self.listen(camera) for camera in ("lost", "camera", "second"))
        before = self.picture(first)["rgb"].header.stamp
        for latest in (first, second):
            self.picture(latest, lambda latest=latest: latest["rgb"].header.stamp > before)
        self.assertEqual(lost, {})


if __name__ == "__main__":
    rospy.init_node("camera_test")
    rostest.rosrun("frontalis", "camera_test", Camera)
