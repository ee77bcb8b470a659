#!/usr/bin/python3
"""A robot face: joints follow a trajectory, anchors follow joints, skin follows anchors, and joints report efforts."""

import unittest

import rospy
import rostest
from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from face import Face, wait

JOINT = "outer_left_lift"
LIFT = 0.006  # [m]


class Robot(unittest.TestCase):
    def setUp(self):
        self.face = Face()
        self.joints, self.forces = {}, []
        rospy.Subscriber("joint_states", JointState, self.take_joints)
        rospy.Subscriber("/face/wrench/anchor_outer_left", WrenchStamped, self.take_wrench)
        # A queue of one would drop the first of two messages in a row if the machine is slow.
        self.command = rospy.Publisher("/robot_controller/command", JointTrajectory, queue_size=10)
        self.face.wait_until_ready()
        wait(self.command.get_num_connections, "the controller")

    def take_joints(self, message):
        self.joints = {name: values for name, *values in zip(message.name, message.position, message.effort)}

    def take_wrench(self, message):
        self.forces.append(message)

    def send(self, joint, position, seconds=0.1):
        point = JointTrajectoryPoint(positions=[position], time_from_start=rospy.Duration(seconds))
        self.command.publish(JointTrajectory(joint_names=[joint], points=[point]))

    def step_until(self, condition, what):
        def holds():
            answer = self.face.step(0.1)
            self.assertTrue(answer.success, answer.message)
            self.face.wait_for_frame(lambda: abs(self.face.state.time - answer.time) < 1e-9, "the state")
            return condition()

        wait(holds, what)

    def brow(self):
        return self.face.height("brow_left")

    def test_moves_and_feels_its_skin(self):
        rest = self.brow()
        self.send(JOINT, LIFT)
        wait(lambda: self.joints.get(JOINT, [0])[0] == LIFT, "the joint")
        self.step_until(lambda: self.brow() - rest > 0.8 * LIFT, "the brow")
        self.assertLess(self.brow() - rest, 1.1 * LIFT)
        # the skin pulls the anchor down, and the joint pulls it up
        self.step_until(lambda: self.forces and self.forces[-1].wrench.force.z < -0.01, "the wrench")
        latest = lambda: abs(self.joints[JOINT][1] + self.forces[-1].wrench.force.z) < 1e-9
        wait(latest, "the effort of the joint")
        self.assertEqual(self.forces[-1].header.frame_id, "face_robot/bone/anchor_outer_left")
        self.assertGreater(self.joints[JOINT][1], 0)

        # trajectories with faults move nothing
        for joint, position in (("nose", 0), (JOINT, 0.1), (JOINT, float("nan"))):
            self.send(joint, position)
        self.send("inner_left_knit", 0.001)
        wait(lambda: self.joints["inner_left_knit"][0] == 0.001, "a good trajectory after bad ones")
        self.assertEqual(self.joints[JOINT][0], LIFT)

        # the joints return to rest
        self.send(JOINT, 0)
        self.send("inner_left_knit", 0)
        self.step_until(lambda: abs(self.brow() - rest) < 2e-4, "the brow at rest")


if __name__ == "__main__":
    rospy.init_node("robot_test")
    rostest.rosrun("frontalis", "robot_test", Robot)
